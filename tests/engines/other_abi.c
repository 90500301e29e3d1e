/* SPDX-License-Identifier: BSD-3-Clause */
/* An engine library that was built for another version of limitcl. */
#include <limitcl/limitcl_engine.h>

const lcl_engine* lcl_engines(uint32_t abi, size_t* count);

const lcl_engine* lcl_engines(uint32_t abi, size_t* count) {
    static const lcl_engine engine = {sizeof(lcl_engine), "other", "", "", "", NULL, NULL};
    if (abi != LCL_ENGINE_ABI + 1) return NULL;
    *count = 1;
    return &engine;
}
