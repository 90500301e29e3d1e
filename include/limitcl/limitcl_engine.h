/* SPDX-License-Identifier: BSD-3-Clause */
/**
 * Engines: what makes a polyhedral approximation of a point cloud for lcl_surface (Doo-Sabin paper, chapter 1: the first of its two steps). An engine is a
 * callback, points in, triangles out. limitcl itself has none, since the good ones are libraries of other licences: each stands in a shared library of its own,
 * which exports lcl_engines() and needs nothing of limitcl but this header.
 */
#ifndef LIMITCL_LIMITCL_ENGINE_H
#define LIMITCL_LIMITCL_ENGINE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Changes when these structs do. */
#define LCL_ENGINE_ABI 1

#define LCL_ENGINE_OK 0
#define LCL_ENGINE_FAILED 1    /**< these points cannot be approximated; fail() was called with the sentence */
#define LCL_ENGINE_OPTION 2    /**< an option is unknown or out of range; fail() was called with the sentence */
#define LCL_ENGINE_CANCELLED 3 /**< progress() returned 0 */
#define LCL_ENGINE_MEMORY 4    /**< too large for the memory; fail() was called with the sentence */

/** What goes in: at least four finite points, all different, not all in a plane. */
typedef struct lcl_engine_points {
    uint32_t struct_size;
    int32_t count;
    const double* points;  /**< count x 3 */
    const double* normals; /**< count x 3: unit, outwards; NULL: none */
} lcl_engine_points;

typedef struct lcl_engine_option {
    const char *key, *value;
} lcl_engine_option;

/** Where results go; every function takes `self` first, may be called from the thread of the call alone, and copies what it is given. */
typedef struct lcl_engine_sink {
    uint32_t struct_size;
    void* self;
    /** fraction: 0 to 1, negative where it is not known. 0: stop and return LCL_ENGINE_CANCELLED. Call it as often as the library at hand allows. */
    int32_t (*progress)(void* self, double fraction);
    /** Once. triangles: triangle_count x 3, corners counter-clockwise seen from outside. points: vertex_count x 3; NULL: the points that came in, and
     * vertex_count is their number. Vertices that no triangle uses are dropped. Need not be manifold or oriented: lcl_surface mends that, and reports it. */
    void (*give)(void* self, int32_t vertex_count, const double* points, int32_t triangle_count, const int32_t* triangles);
    /** Points that the engine's options told it to leave out as outliers: they are not measured later. */
    void (*leave_out)(void* self, int32_t count, const int32_t* indices);
    /** A sentence that people should see. */
    void (*warn)(void* self, const char* sentence);
    void (*fail)(void* self, const char* sentence);
} lcl_engine_sink;

typedef struct lcl_engine {
    uint32_t struct_size;
    const char* name;        /**< "advancing-front" */
    const char* description; /**< one line: the method, the library and its version */
    const char* licence;     /**< of what it links, SPDX: "GPL-3.0-or-later" */
    const char* options;     /**< a line for each option: "KEY=DEFAULT  what it does, its range"; "" for none */
    /** Returns LCL_ENGINE_*; no exception leaves it, and nothing is printed. */
    int32_t (*run)(void* user, const lcl_engine_points* points, const lcl_engine_option* options, size_t option_count, const lcl_engine_sink* sink);
    void* user;
} lcl_engine;

/** What an engine library exports under the name "lcl_engines": its engines, the best first, which live as long as the library is loaded. NULL where it was
 * built for another `abi`. */
typedef const lcl_engine* (*lcl_engines_function)(uint32_t abi, size_t* count);

#ifdef __cplusplus
}
#endif

#endif
