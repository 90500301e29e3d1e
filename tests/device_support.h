// SPDX-License-Identifier: BSD-3-Clause
// What the tests of the device layer share.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

#include "host/device/device.h"

namespace device_test {

/// Sets (or, for a null value, removes) an environment variable until the end of the scope.
class Environment {
public:
    Environment(const char* name, const char* value) : name_(name) {
        if (const char* before = std::getenv(name)) before_ = before;
        set(value);
    }
    ~Environment() { set(before_ ? before_->c_str() : nullptr); }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;

private:
    void set(const char* value) { value ? setenv(name_.c_str(), value, 1) : unsetenv(name_.c_str()); }
    std::string name_;
    std::optional<std::string> before_;
};

inline bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// How an array of a caller lies in memory, in elements, and which of its channels make a row.
struct Layout {
    cl_ulong stride = 1, offset = 0;
    cl_uint first = 0, channels = 1;
};

/// lcl_import_points or lcl_export_points: both take the same arguments.
inline lcl::Event transfer(lcl::Context& context, cl_kernel kernel, std::size_t count, const Layout& layout, const lcl::Buffer& order, const lcl::Buffer& frame,
                           const lcl::Buffer& from, const lcl::Buffer& to) {
    const std::size_t local = 64;
    return launch(context, kernel, {(count + local - 1) / local * local, local}, static_cast<cl_uint>(count), layout.stride, layout.offset, layout.first,
                  layout.channels, order, frame, from, to);
}

template <class Array>
lcl::Buffer upload(const std::shared_ptr<lcl::Context>& context, const Array& values, const std::string& what) {
    const std::size_t bytes = values.size() * sizeof values[0];
    lcl::Buffer buffer(context, bytes, what);
    context->write(buffer, 0, bytes, values.data(), "writing " + what);
    return buffer;
}

}  // namespace device_test
