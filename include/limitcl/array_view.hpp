// SPDX-License-Identifier: BSD-3-Clause
// A pointer with a size: how the C++ API takes arrays without a copy.
#ifndef LIMITCL_ARRAY_VIEW_HPP
#define LIMITCL_ARRAY_VIEW_HPP

#include <array>
#include <cstddef>
#include <vector>

namespace limitcl {

/// Read-only view of `size` values that belong to someone else. Used for arguments only: nothing in the API keeps one after the call.
template <class T>
class ArrayView {
public:
    ArrayView() = default;
    ArrayView(const T* data, std::size_t size) : data_(data), size_(size) {}
    ArrayView(const std::vector<T>& values) : data_(values.data()), size_(values.size()) {}
    template <std::size_t N>
    ArrayView(const std::array<T, N>& values) : data_(values.data()), size_(N) {}
    template <std::size_t N>
    ArrayView(const T (&values)[N]) : data_(values), size_(N) {}

    const T* data() const { return data_; }
    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const T* begin() const { return data_; }
    const T* end() const { return data_ + size_; }
    const T& operator[](std::size_t i) const { return data_[i]; }

private:
    const T* data_ = nullptr;
    std::size_t size_ = 0;
};

}  // namespace limitcl

#endif
