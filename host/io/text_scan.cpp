// SPDX-License-Identifier: BSD-3-Clause
#include "host/io/text_scan.h"

#include <cctype>

namespace lcl {
namespace {

/// The decimal exponent behind an 'e', cut off at a million: more cannot matter.
long written_exponent(const char* at, const char* last) {
    if (at == last || (*at != 'e' && *at != 'E')) return 0;
    ++at;
    const bool is_negative = at != last && *at == '-';
    if (at != last && (*at == '-' || *at == '+')) ++at;
    long value = 0;
    for (; at != last && std::isdigit(static_cast<unsigned char>(*at)); ++at) value = std::min(1000000L, value * 10 + (*at - '0'));
    return is_negative ? -value : value;
}

}  // namespace

double out_of_range_number(const char* first, const char* last) {
    const bool is_negative = *first == '-';
    long order = 0;  // decimal places from the first digit that counts to the point
    bool counts = false, behind_point = false;
    const char* at = first + (*first == '-' || *first == '+');
    for (; at != last && (*at == '.' || std::isdigit(static_cast<unsigned char>(*at))); ++at) {
        if (*at == '.') {
            behind_point = true;
            continue;
        }
        counts = counts || *at != '0';
        order += behind_point ? -(counts ? 0 : 1) : (counts ? 1 : 0);
    }
    const double value = order + written_exponent(at, last) > 0 ? std::numeric_limits<double>::infinity() : 0.0;
    return is_negative ? -value : value;
}

}  // namespace lcl
