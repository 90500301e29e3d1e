// SPDX-License-Identifier: BSD-3-Clause
// The test program's main, in an object of its own because it compiles slowly.
#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include "tests/at_end.h"

namespace {

struct Closing : Catch::TestEventListenerBase {
    using TestEventListenerBase::TestEventListenerBase;
    void testRunEnded(const Catch::TestRunStats&) override {
        for (; !at_end().empty(); at_end().pop_back()) at_end().back()();
    }
};

}  // namespace

CATCH_REGISTER_LISTENER(Closing)
