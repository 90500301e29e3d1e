// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/program.h"

int main(int argc, char** argv) { return lcl::cli::run_program(argc, argv); }
