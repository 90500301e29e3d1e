/* SPDX-License-Identifier: BSD-3-Clause */
/* An engine for point clouds whose faces are known beforehand: tests of the program choose by it what comes out of an engine, on every machine. C99, against
 * limitcl_engine.h alone. */
#include <limitcl/limitcl_engine.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char* value_of(const lcl_engine_option* options, size_t count, const char* key) {
    for (size_t i = 0; i < count; ++i) {
        if (strcmp(options[i].key, key) == 0) return options[i].value;
    }
    return NULL;
}

static int32_t refuse_unknown(const lcl_engine_option* options, size_t count, const lcl_engine_sink* sink) {
    for (size_t i = 0; i < count; ++i) {
        const char* key = options[i].key;
        char sentence[256];
        if (strcmp(key, "faces") == 0 || strcmp(key, "outliers") == 0 || strcmp(key, "wait") == 0 || strcmp(key, "warn") == 0) continue;
        snprintf(sentence, sizeof sentence, "given-faces has no option '%.100s': it takes faces, outliers, wait and warn", key);
        sink->fail(sink->self, sentence);
        return LCL_ENGINE_OPTION;
    }
    return LCL_ENGINE_OK;
}

/** Three indices a line. NULL: it cannot be opened. The caller frees. */
static int32_t* read_triangles(const char* path, int32_t* count) {
    FILE* file = fopen(path, "r");
    int32_t* corners = NULL;
    size_t size = 0, room = 0;
    int index;
    if (!file) return NULL;
    while (fscanf(file, "%d", &index) == 1) {
        if (size == room) corners = (int32_t*)realloc(corners, (room = 2 * room + 300) * sizeof(int32_t));
        if (!corners) abort();
        corners[size++] = (int32_t)index;
    }
    fclose(file);
    *count = (int32_t)(size / 3);
    return corners ? corners : (int32_t*)calloc(1, sizeof(int32_t));
}

/** The last points of the cloud. */
static void leave_out(const lcl_engine_points* points, int32_t count, const lcl_engine_sink* sink) {
    for (int32_t i = points->count - count; i < points->count; ++i) sink->leave_out(sink->self, 1, &i);
}

static int32_t run(void* user, const lcl_engine_points* points, const lcl_engine_option* options, size_t option_count, const lcl_engine_sink* sink) {
    const char *faces = value_of(options, option_count, "faces"), *outliers = value_of(options, option_count, "outliers"),
               *warning = value_of(options, option_count, "warn");
    int32_t triangle_count = 0;
    int32_t* triangles;
    const int32_t unknown = refuse_unknown(options, option_count, sink);
    (void)user;
    if (unknown != LCL_ENGINE_OK) return unknown;
    while (value_of(options, option_count, "wait") && sink->progress(sink->self, 0.5)) continue;
    if (!sink->progress(sink->self, 1.0)) return LCL_ENGINE_CANCELLED;
    triangles = faces ? read_triangles(faces, &triangle_count) : NULL;
    if (!triangles) {
        sink->fail(sink->self, "given-faces: the file of --engine-option faces=FILE cannot be read");
        return LCL_ENGINE_FAILED;
    }
    if (warning) sink->warn(sink->self, warning);
    if (outliers) leave_out(points, (int32_t)atoi(outliers), sink);
    sink->give(sink->self, points->count, NULL, triangle_count, triangles);
    free(triangles);
    return LCL_ENGINE_OK;
}

static const lcl_engine engine = {(uint32_t)sizeof(lcl_engine),
                                  "given-faces",
                                  "triangles from a file",
                                  "BSD-3-Clause",
                                  "faces=FILE  triangles, three zero-based points a line\noutliers=0  so many points at the end are left out\n"
                                  "wait=1  until the caller cancels\nwarn=  a sentence to warn with",
                                  run,
                                  NULL};

__attribute__((visibility("default"))) const lcl_engine* lcl_engines(uint32_t abi, size_t* count);

const lcl_engine* lcl_engines(uint32_t abi, size_t* count) {
    *count = 1;
    return abi == LCL_ENGINE_ABI ? &engine : NULL;
}
