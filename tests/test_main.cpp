// SPDX-License-Identifier: BSD-3-Clause
// The test program's main, in an object of its own because it compiles slowly.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>
