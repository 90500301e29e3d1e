// SPDX-License-Identifier: BSD-3-Clause
// Arrays of numbers that are written once, by all cores, right after they are made.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <utility>
#include <vector>

#ifdef __linux__
#include <sys/mman.h>
#endif

namespace lcl {

/// Asks for 2 MiB pages where a block of memory covers some: touching fresh memory then costs half. Elsewhere than on Linux: nothing.
inline void advise_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) {
#ifdef __linux__
    constexpr std::uintptr_t page = std::uintptr_t{1} << 21;
    const auto begin = (reinterpret_cast<std::uintptr_t>(memory) + page - 1) / page * page,
               end = (reinterpret_cast<std::uintptr_t>(memory) + bytes) / page * page;
    if (begin < end) madvise(reinterpret_cast<void*>(begin), end - begin, MADV_HUGEPAGE);  // advice only: it may be refused
#endif
}

/// Leaves numbers unset where std::allocator sets them to zero, so that the cores that fill an array are the first to touch it.
template <class T>
struct UnsetAllocator : std::allocator<T> {
    template <class U>
    struct rebind {
        using other = UnsetAllocator<U>;
    };
    UnsetAllocator() = default;
    template <class U>
    UnsetAllocator(const UnsetAllocator<U>&) noexcept {}

    T* allocate(std::size_t count) {
        T* memory = std::allocator<T>::allocate(count);
        advise_huge_pages(memory, count * sizeof(T));
        return memory;
    }
    template <class U>
    void construct(U* place) {
        ::new (static_cast<void*>(place)) U;
    }
    template <class U, class... Arguments>
    void construct(U* place, Arguments&&... arguments) {
        ::new (static_cast<void*>(place)) U(std::forward<Arguments>(arguments)...);
    }
};

/// A std::vector whose resize() and size constructor leave new numbers unset.
template <class T>
using Array = std::vector<T, UnsetAllocator<T>>;

}  // namespace lcl
