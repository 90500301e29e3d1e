// SPDX-License-Identifier: BSD-3-Clause
#include "host/scheme/scheme.h"

namespace lcl {

const char* scheme_name(Scheme scheme) {
    switch (scheme) {
        case Scheme::catmull_clark: return "catmull-clark";
        case Scheme::loop: return "loop";
        case Scheme::doo_sabin: return "doo-sabin";
    }
    return "";
}

}  // namespace lcl
