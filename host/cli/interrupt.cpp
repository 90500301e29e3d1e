// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/interrupt.h"

#include <csignal>

#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

volatile std::sig_atomic_t interrupt_flag = 0;

void on_interrupt(int) { interrupt_flag = 1; }

}  // namespace

void watch_signals() {
    struct sigaction action = {};
    action.sa_handler = on_interrupt;
    action.sa_flags = SA_RESETHAND;  // and no SA_RESTART: a read from standard input that waits comes back
    sigaction(SIGINT, &action, nullptr);
    std::signal(SIGPIPE, SIG_IGN);
}

bool interrupted() { return interrupt_flag != 0; }

void check_interrupt() {
    if (interrupted()) throw failure_of(LCL_ERROR_CANCELLED);
}

}  // namespace lcl::cli
