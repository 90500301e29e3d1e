// SPDX-License-Identifier: BSD-3-Clause
// The commands of the program, one file each. They return when all is done and throw Failure otherwise.
#pragma once

#include "host/cli/job.h"

namespace lcl::cli {

void run_devices(Job& job);
void run_selftest(Job& job);
void run_info(Job& job);
void run_interpolate(Job& job);
void run_limit(Job& job);
void run_refine(Job& job);
void run_expand(Job& job);
void run_spectrum(Job& job);
void run_denoise(Job& job);
void run_sharpen(Job& job);
void run_morph(Job& job);
void run_texture(Job& job);
void run_evaluate(Job& job);
void run_closest(Job& job);
void run_surface(Job& job);

}  // namespace lcl::cli
