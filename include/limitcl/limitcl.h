/* SPDX-License-Identifier: BSD-3-Clause */
/**
 * limitcl: control meshes whose subdivision limit surface passes exactly through given vertices. The C API; its comments are the reference.
 *
 * In ten lines (errors left out):
 *
 *     lcl_context context;  lcl_context_create(NULL, &context);                     the default device, see lcl_context_options
 *     lcl_mesh mesh;        lcl_mesh_read("bunny.obj", LCL_FORMAT_BY_ENDING, &mesh);
 *     lcl_operator A;       lcl_operator_create(context, mesh, NULL, &A);           Loop for triangles, else Catmull-Clark
 *     lcl_solve_report report = LCL_SOLVE_REPORT_INIT;
 *     lcl_interpolate_mesh(A, mesh, NULL, &report);                                 mesh now holds the control points P with A P = M
 *     lcl_mesh_write(mesh, "control.obj", LCL_FORMAT_BY_ENDING);
 *     lcl_operator_release(A);  lcl_mesh_release(mesh);  lcl_context_release(context);
 *
 * Notation. M: the given vertices, n x c (positions are the first three channels). A: the limit operator; row i gives the limit point of vertex i.
 * P: control points. S(P): the limit surface. "mesh expansion paper", "Loop PIA paper", "two-phase paper", "Doo-Sabin paper": see the README.
 *
 * Conventions.
 * - Every function that can fail returns an lcl_status: LCL_OK (0), an OpenCL error as it is (-1 to -99), or one of LCL_ERROR_* (-1100 and below).
 *   lcl_last_error() gives the sentence: what, where, what to do. The library never prints and never throws.
 * - Handles are reference counted: _create makes one reference, _retain adds one, _release drops one (NULL is allowed). What a handle needs it keeps alive.
 * - Arrays that a caller passes in are copied before the call returns; outputs go to the caller's memory. Strings that the library gives out live as long as
 *   their handle, lcl_last_error()'s until the next failing call of the thread.
 * - Options structs begin with struct_size: start from LCL_..._INIT. Zeros mean the default, but for members whose comment says what the _INIT holds, where 0
 * is a value like any other. NULL options mean all defaults.
 * - One context is one device and one thread at a time. Different contexts are independent, also on one device; operators on several devices run at once.
 *   A mesh may be read by several threads; functions that change it need it alone.
 * - Indices are zero-based. At most 2^31 - 1 of anything.
 * - Costs are given in passes: one pass is one application of A to all channels.
 */
#ifndef LIMITCL_LIMITCL_H
#define LIMITCL_LIMITCL_H

#include <stddef.h>
#include <stdint.h>

#include <limitcl/limitcl_engine.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(LIMITCL_STATIC)
#define LCL_API
#elif defined(__GNUC__)
#define LCL_API __attribute__((visibility("default")))
#else
#define LCL_API
#endif

/* Any number may come from a C caller: C++ has to know that it fits. */
#ifdef __cplusplus
#define LCL_ENUM(name) enum name : int32_t
#else
#define LCL_ENUM(name) enum name
#endif

/* ---------------------------------------------------------------- version */

#define LCL_VERSION_MAJOR 0
#define LCL_VERSION_MINOR 1
#define LCL_VERSION_PATCH 0

/** major * 10000 + minor * 100 + patch of the library that runs (the header's: LCL_VERSION_*). */
LCL_API int32_t lcl_version(void);
/** "0.1.0". */
LCL_API const char* lcl_version_string(void);
/** One line on how the library was built: compiler, build type, revision of the sources if known. */
LCL_API const char* lcl_build_string(void);

/* ---------------------------------------------------------------- status */

typedef int32_t lcl_status;

#define LCL_OK 0
#define LCL_ERROR_INVALID_ARGUMENT (-1100) /**< an argument or option is wrong: null, out of range, options that exclude each other */
#define LCL_ERROR_BAD_INPUT (-1101)        /**< a mesh or the content of a file is wrong */
#define LCL_ERROR_UNSUPPORTED (-1102)      /**< right, but not offered here */
#define LCL_ERROR_FILE (-1103)             /**< a file cannot be opened or read */
#define LCL_ERROR_WRITE (-1104)            /**< a file cannot be written; what was there before is still there */
#define LCL_ERROR_NO_DEVICE (-1105)        /**< no OpenCL device, or none of that name */
#define LCL_ERROR_MEMORY (-1106)           /**< too large for the device or the memory; the sentence has the numbers */
#define LCL_ERROR_CANCELLED (-1107)        /**< a progress callback returned 0 */
#define LCL_ERROR_INTERNAL (-1108)         /**< a defect of the library: please report the sentence */
/* The next three are results: outputs and report are filled with what there is. */
#define LCL_ERROR_SINGULAR (-1110)   /**< A has no inverse: interpolation is not possible with these parameters; the report names the vertices and the cure */
#define LCL_ERROR_INDEFINITE (-1111) /**< A has negative eigenvalues (valence 2): none of the iterations is sure to converge, and none did */
#define LCL_ERROR_NOT_CONVERGED (-1112) /**< the tolerance was not reached */

/** Name of a status: "LCL_ERROR_SINGULAR", "CL_OUT_OF_RESOURCES". Never NULL. */
LCL_API const char* lcl_status_string(lcl_status status);
/** The sentence of the last failure on this thread; "" if there was none. */
LCL_API const char* lcl_last_error(void);
/** Vertices and faces that the last failure on this thread speaks of: writes up to `capacity` (at most ten are kept), returns the number kept. */
LCL_API size_t lcl_last_error_vertices(int32_t* vertices, size_t capacity);
LCL_API size_t lcl_last_error_faces(int32_t* faces, size_t capacity);

/* ---------------------------------------------------------------- handles */

typedef struct lcl_context_s* lcl_context;             /**< one OpenCL device with its queues and programs */
typedef struct lcl_mesh_s* lcl_mesh;                   /**< polygons, points, sharp features, and what a file carried beside them */
typedef struct lcl_operator_s* lcl_operator;           /**< the limit operator A of one mesh and scheme on one context */
typedef struct lcl_field_s* lcl_field;                 /**< n x c values that stay on a device */
typedef struct lcl_task_s* lcl_task;                   /**< a call that runs beside the caller */
typedef struct lcl_refiner_s* lcl_refiner;             /**< a refinement of one mesh, made once and applied often */
typedef struct lcl_limit_surface_s* lcl_limit_surface; /**< the limit surface of a mesh as patches, with its control points on a context's device */
typedef struct lcl_samples_s* lcl_samples;             /**< places on a limit surface, found once and evaluated often */
typedef struct lcl_tangents_s* lcl_tangents;           /**< limit tangents at the vertices of an operator's mesh, for normals */
typedef struct lcl_cloud_s* lcl_cloud;                 /**< points with normals and colours where there are any */

/* ---------------------------------------------------------------- devices and contexts */

typedef struct lcl_device_info {
    uint32_t struct_size;
    int32_t index; /**< place in the list, -1 for a caller's context */
    char platform[128], name[256], version[128], driver[128], vendor[128];
    int32_t is_gpu, is_cpu;
    int32_t has_double; /**< double-precision arithmetic */
    uint32_t compute_units, clock_mhz;
    uint64_t memory_bytes, max_allocation_bytes;
} lcl_device_info;
#define LCL_DEVICE_INFO_INIT \
    { (uint32_t)sizeof(lcl_device_info), 0, "", "", "", "", "", 0, 0, 0, 0, 0, 0, 0 }

/** Number of OpenCL devices of all platforms; 0 if there is none. */
LCL_API int32_t lcl_device_count(void);
LCL_API lcl_status lcl_device_get_info(int32_t index, lcl_device_info* info);

typedef LCL_ENUM(lcl_log_level){LCL_LOG_ERROR = 0, LCL_LOG_WARNING = 1, LCL_LOG_INFO = 2, LCL_LOG_DEBUG = 3} lcl_log_level;
typedef void (*lcl_log_callback)(void* user, int32_t level, const char* message);

typedef struct lcl_context_options {
    uint32_t struct_size;
    int32_t profiling;  /**< 1: queues with profiling */
    const char* device; /**< index, part of a name (any case, the first that matches), "cpu" or "gpu"; NULL: environment LIMITCL_DEVICE, else the GPU with
                             the largest compute units x clock, else the CPU */
    const char* cache_directory; /**< built programs; NULL: LIMITCL_CACHE_DIR, else the user's cache folder; not writable: no cache, no error */
    lcl_log_callback log;        /**< NULL: none; called on the thread of the call, with no lock held */
    void* log_user;
    int32_t log_level; /**< messages up to this level */
} lcl_context_options;
#define LCL_CONTEXT_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_context_options), 0, NULL, NULL, NULL, NULL, 0 }

/** Opens a device. LCL_ERROR_NO_DEVICE names what was asked for, what there is, and how to install one. limitcl_opencl.h makes one from a cl_context. */
LCL_API lcl_status lcl_context_create(const lcl_context_options* options, lcl_context* context);
LCL_API void lcl_context_retain(lcl_context context);
LCL_API void lcl_context_release(lcl_context context);
LCL_API lcl_status lcl_context_get_device(lcl_context context, lcl_device_info* info);
/** Waits until everything that was put on the context's queues is done. */
LCL_API lcl_status lcl_context_finish(lcl_context context);
/** Seconds spent building programs so far, and bytes that fields and operators hold on the device now. */
LCL_API double lcl_context_compile_seconds(lcl_context context);
LCL_API uint64_t lcl_context_allocated_bytes(lcl_context context);

/** Called by the self-test once per kernel: the largest difference to the plain double-precision host operator, and what is allowed. */
typedef void (*lcl_selftest_callback)(void* user, const char* kernel, const char* what, double difference, double tolerance, int32_t passed);
/** Runs every kernel on built-in meshes against the plain host operator. LCL_ERROR_INTERNAL if one disagrees; all are run in any case. Some seconds at first.
 */
LCL_API lcl_status lcl_context_selftest(lcl_context context, lcl_selftest_callback callback, void* user);

/* ---------------------------------------------------------------- meshes */

typedef LCL_ENUM(lcl_format){LCL_FORMAT_BY_ENDING = 0,
                             LCL_FORMAT_OBJ = 1,
                             LCL_FORMAT_OFF = 2,
                             LCL_FORMAT_PLY = 3,
                             LCL_FORMAT_STL = 4,
                             LCL_FORMAT_OM = 5,
                             LCL_FORMAT_XYZ = 6 /**< this and what follows: points alone */,
                             LCL_FORMAT_CSV = 7,
                             LCL_FORMAT_PTS = 8} lcl_format;

typedef LCL_ENUM(lcl_type){LCL_TYPE_DOUBLE = 0, LCL_TYPE_FLOAT = 1} lcl_type;

/** A mesh in the caller's arrays. */
typedef struct lcl_mesh_data {
    uint32_t struct_size;
    int32_t vertex_count, face_count;
    const int32_t* face_degrees; /**< face_count sides; NULL: all faces have `uniform_degree` */
    int32_t uniform_degree;
    const int32_t* face_vertices; /**< sum of the degrees */
    const void* points;           /**< vertex_count points of three values, model units */
    lcl_type point_type;
    size_t point_stride; /**< values from one point to the next; 0: 3 */
} lcl_mesh_data;
#define LCL_MESH_DATA_INIT \
    { (uint32_t)sizeof(lcl_mesh_data), 0, 0, NULL, 0, NULL, NULL, LCL_TYPE_DOUBLE, 0 }

/** Copies a mesh from arrays. Counts and pointers are checked here; the mesh itself where a function needs it sound (or by lcl_mesh_validate). */
LCL_API lcl_status lcl_mesh_create(const lcl_mesh_data* data, lcl_mesh* mesh);
/** Reads .obj .off .ply .stl .om, each also with .gz. path "-" is standard input and needs a format. */
LCL_API lcl_status lcl_mesh_read(const char* path, lcl_format format, lcl_mesh* mesh);
/** The same from bytes in memory; `name` stands in messages. */
LCL_API lcl_status lcl_mesh_read_memory(const void* bytes, size_t size, lcl_format format, const char* name, lcl_mesh* mesh);
/** The same two, and the normals of the vertices that the file holds are kept for lcl_mesh_get_normals: OBJ vn (the mean of those of a vertex's corners), PLY
 * nx ny nz, OFF with N. Other formats have none. Reading them takes time, so lcl_mesh_read does not. */
LCL_API lcl_status lcl_mesh_read_with_normals(const char* path, lcl_format format, lcl_mesh* mesh);
LCL_API lcl_status lcl_mesh_read_memory_with_normals(const void* bytes, size_t size, lcl_format format, const char* name, lcl_mesh* mesh);
/** Writes completely or not at all, a sound mesh. Counts as a change of the mesh: what the format cannot hold is added to its notes of kind LCL_NOTE_WARNING.
 * path "-" is standard output and needs a format. */
LCL_API lcl_status lcl_mesh_write(lcl_mesh mesh, const char* path, lcl_format format);
/** The format that a path's ending names, of points alone too: the functions of meshes refuse those. */
LCL_API lcl_status lcl_format_of_path(const char* path, lcl_format* format);
/** A copy with its own points: faces, features, properties and all else a file carried. */
LCL_API lcl_status lcl_mesh_copy(lcl_mesh mesh, lcl_mesh* copy);
LCL_API void lcl_mesh_retain(lcl_mesh mesh);
LCL_API void lcl_mesh_release(lcl_mesh mesh);

LCL_API int32_t lcl_mesh_vertex_count(lcl_mesh mesh);
LCL_API int32_t lcl_mesh_face_count(lcl_mesh mesh);
LCL_API int32_t lcl_mesh_corner_count(lcl_mesh mesh);
/** face_degrees: face_count; face_vertices: corner_count. Either may be NULL. */
LCL_API lcl_status lcl_mesh_get_faces(lcl_mesh mesh, int32_t* face_degrees, int32_t* face_vertices);
/** points: vertex_count rows of three, `stride` values apart (0: 3). */
LCL_API lcl_status lcl_mesh_get_points(lcl_mesh mesh, double* points, size_t stride);
LCL_API lcl_status lcl_mesh_set_points(lcl_mesh mesh, const double* points, size_t stride);
/** Unit normals that a writer puts beside the points (OBJ vn, PLY nx ny nz, OFF NOFF); NULL: none. vertex_count x 3. */
LCL_API lcl_status lcl_mesh_set_normals(lcl_mesh mesh, const double* normals);
/** Normals as the file that the mesh was read from holds them, of any length: vertex_count x 3, NaN where the file gives a vertex none. LCL_ERROR_BAD_INPUT
 * where it holds no normals at all; LCL_ERROR_INVALID_ARGUMENT for a mesh that was not read with them, or whose points were changed since. */
LCL_API lcl_status lcl_mesh_get_normals(lcl_mesh mesh, double* normals);

/** Sharp features, beside the boundary. */
typedef LCL_ENUM(lcl_boundary){
    LCL_BOUNDARY_DEFAULT = 0,         /**< the file's `t interpolateboundary`, else edge-and-corner */
    LCL_BOUNDARY_EDGE_AND_CORNER = 1, /**< boundary curves; vertices with one face are corners */
    LCL_BOUNDARY_EDGE_ONLY = 2,       /**< boundary curves everywhere */
    LCL_BOUNDARY_FIXED = 3            /**< every boundary vertex is a corner */
} lcl_boundary;

typedef struct lcl_features {
    uint32_t struct_size;
    lcl_boundary boundary;
    const int32_t* creases; /**< crease_count pairs of vertices, added to those of the file */
    size_t crease_count;
    const int32_t* corners; /**< corner_count vertices that stay, added to those of the file */
    size_t corner_count;
    double crease_angle_degrees; /**< > 0: edges whose face normals (Newell) differ by more are creases */
} lcl_features;
#define LCL_FEATURES_INIT \
    { (uint32_t)sizeof(lcl_features), LCL_BOUNDARY_DEFAULT, NULL, 0, NULL, 0, 0.0 }

/** Adds sharp features and sets the boundary rule; operators made before keep what they were made with. */
LCL_API lcl_status lcl_mesh_add_features(lcl_mesh mesh, const lcl_features* features);
/** The resolved features: crease edges off the boundary and corners, however they were found. Either array may be NULL; counts may be NULL. creases: 2 values
 * an edge. */
LCL_API lcl_status lcl_mesh_get_features(lcl_mesh mesh, lcl_boundary* boundary, int32_t* creases, size_t* crease_count, int32_t* corners, size_t* corner_count);

typedef struct lcl_mesh_info {
    uint32_t struct_size;
    int32_t vertices, faces, edges, boundary_edges, boundary_loops, components, isolated_vertices;
    int32_t creases; /**< sharp edges off the boundary */
    int32_t corners; /**< vertices that stay, isolated ones not counted */
    double diagonal; /**< of the bounding box of the vertices that a face uses, model units; 0 where a face uses a vertex that is not there */
} lcl_mesh_info;
#define LCL_MESH_INFO_INIT \
    { (uint32_t)sizeof(lcl_mesh_info), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.0 }

/** Counts. On a mesh that is not sound, edges and what follows from them are -1 and the call still succeeds. */
LCL_API lcl_status lcl_mesh_get_info(lcl_mesh mesh, lcl_mesh_info* info);
typedef LCL_ENUM(lcl_histogram){LCL_HISTOGRAM_FACE_DEGREES = 0, LCL_HISTOGRAM_VALENCES = 1 /**< edges at a vertex */} lcl_histogram;
/** Keys in ascending order with their counts; `size` receives the number of all. Valences need a sound mesh (LCL_ERROR_BAD_INPUT). */
LCL_API lcl_status lcl_mesh_get_histogram(lcl_mesh mesh, lcl_histogram which, int32_t* keys, int32_t* counts, size_t capacity, size_t* size);

/** LCL_OK if the mesh is manifold, consistently oriented and finite, no face has fewer than three corners or a vertex twice, and the file had no tag that is
 * refused (semi-sharp creases, `t interpolateboundary` 0 with a boundary); else LCL_ERROR_BAD_INPUT with the first reason. Linear time, remembered. */
LCL_API lcl_status lcl_mesh_validate(lcl_mesh mesh);

typedef struct lcl_defect {
    uint32_t struct_size;
    const char* kind;    /**< index-range, repeated-vertex, short-face, edge-with-three-faces, non-manifold-vertex, orientation, not-finite, zero-area */
    const char* message; /**< one sentence on the first */
    int64_t count;
    int32_t vertices[10], faces[10]; /**< the first ten */
    int32_t vertex_count, face_count;
} lcl_defect;
#define LCL_DEFECT_INIT \
    { (uint32_t)sizeof(lcl_defect), NULL, NULL, 0, {0}, {0}, 0, 0 }
LCL_API int32_t lcl_mesh_defect_count(lcl_mesh mesh);
LCL_API lcl_status lcl_mesh_get_defect(lcl_mesh mesh, int32_t index, lcl_defect* defect);

/** Per-vertex data that a file carried: colours and PLY scalar properties. They pass through to the output unless they are made channels. */
LCL_API int32_t lcl_mesh_property_count(lcl_mesh mesh);
LCL_API const char* lcl_mesh_property_name(lcl_mesh mesh, int32_t index);
LCL_API int32_t lcl_mesh_property_is_colour(lcl_mesh mesh, int32_t index);
LCL_API lcl_status lcl_mesh_get_property(lcl_mesh mesh, int32_t index, double* values /* vertex_count */);
/** Sets the values of a property that is there (`name` exists) or adds one of type double. An integer property becomes double, with a note, where it could not
 * hold them. */
LCL_API lcl_status lcl_mesh_set_property(lcl_mesh mesh, const char* name, const double* values);
/** Colours of the vertices, which writers put beside the points in 8 bits; those that were there are replaced, an alpha stays. colours: vertex_count x (red,
 * green, blue) from 0 to 1. */
LCL_API lcl_status lcl_mesh_set_colours(lcl_mesh mesh, const double* colours);

typedef LCL_ENUM(lcl_note){
    LCL_NOTE_WARNING = 0,           /**< sentences on what could not be kept or was doubtful, from reading, refining and writing */
    LCL_NOTE_IGNORED_TAG = 1,       /**< names of OBJ tags that were ignored */
    LCL_NOTE_UNKNOWN_STATEMENT = 2, /**< "NAME COUNT" of OBJ statements that were skipped */
    LCL_NOTE_REFUSED_TAG = 3        /**< the sentence that refuses a tag of the file; every function that needs a sound mesh fails with it */
} lcl_note;
LCL_API int32_t lcl_mesh_note_count(lcl_mesh mesh, lcl_note kind);
LCL_API const char* lcl_mesh_note(lcl_mesh mesh, lcl_note kind, int32_t index);

/* ---------------------------------------------------------------- schemes */

typedef LCL_ENUM(lcl_scheme){LCL_SCHEME_DEFAULT = 0 /**< Loop if all faces are triangles, else Catmull-Clark */, LCL_SCHEME_CATMULL_CLARK = 1,
                             LCL_SCHEME_LOOP = 2, LCL_SCHEME_DOO_SABIN = 3} lcl_scheme;
typedef LCL_ENUM(lcl_mask){LCL_MASK_CATMULL = 0 /**< Doo-Sabin paper, chapter 4 */, LCL_MASK_CLASSIC = 1 /**< Doo & Sabin 1978 */} lcl_mask;

typedef struct lcl_scheme_options {
    uint32_t struct_size;
    lcl_scheme scheme;
    lcl_mask mask; /**< Doo-Sabin */
    double alpha;  /**< Catmull-Clark, 0 to 1: rule of the first refinement (mesh expansion paper) */
    int32_t
        alpha_auto; /**< 1 (for operators; alpha is left at 0): alpha is 0, or 0.5 where 0 is singular, indefinite, or has an estimated lambda_min below 0.05 */
    double lambda;  /**< Catmull-Clark, 0 to 1: two-phase blend ratio, A_lambda = lambda E + (1 - lambda) A (two-phase paper, eq. 5) */
    const double* lambda_per_vertex; /**< NULL, or one ratio a vertex; rules over lambda */
    const int32_t* subset;           /**< NULL, or the vertices to interpolate: the others keep their control points (identity rows) */
    size_t subset_count;
    const int32_t* owned; /**< NULL, or the vertices that get rows: the others are ghosts, whose values come from elsewhere (lcl_field_write_vertices) */
    size_t owned_count;
} lcl_scheme_options;
#define LCL_SCHEME_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_scheme_options), LCL_SCHEME_DEFAULT, LCL_MASK_CATMULL, 0.0, 0, 0.0, NULL, NULL, 0, NULL, 0 }

typedef struct lcl_suitability {
    uint32_t struct_size;
    int32_t suitable;                   /**< the scheme can be used on this mesh */
    int32_t singular;                   /**< its limit operator (alpha 0, lambda 0 unless given) has no inverse: exact criterion */
    char reason[512];                   /**< why not suitable, or why singular and the cure; "" otherwise */
    int32_t vertices[10], vertex_count; /**< where */
} lcl_suitability;
#define LCL_SUITABILITY_INIT \
    { (uint32_t)sizeof(lcl_suitability), 0, 0, "", {0}, 0 }
/** Whether a scheme fits a mesh. Linear time, no device. */
LCL_API lcl_status lcl_mesh_check_scheme(lcl_mesh mesh, const lcl_scheme_options* options, lcl_suitability* suitability);

/* ---------------------------------------------------------------- limit operators */

/** Builds A of a mesh and puts it on the context's device: validation, topology, ordering, upload. The operator keeps no reference to the mesh. Linear time. */
LCL_API lcl_status lcl_operator_create(lcl_context context, lcl_mesh mesh, const lcl_scheme_options* options, lcl_operator* A);
LCL_API void lcl_operator_retain(lcl_operator A);
LCL_API void lcl_operator_release(lcl_operator A);
LCL_API int32_t lcl_operator_vertex_count(lcl_operator A);
/** Number of rows: vertex_count, or the number of owned vertices. */
LCL_API int32_t lcl_operator_row_count(lcl_operator A);
/** The scheme and parameters in use (alpha after alpha_auto); pointers are NULL. LCL_SCHEME_DEFAULT, none, for operators of your own. */
LCL_API lcl_status lcl_operator_get_scheme(lcl_operator A, lcl_scheme_options* options);
/** Row `vertex` of A in double: writes up to `capacity` entries (column vertices in ascending order, each once), `size` receives the number of all. */
LCL_API lcl_status lcl_operator_get_row(lcl_operator A, int32_t vertex, int32_t* columns, double* weights, size_t capacity, size_t* size);

typedef struct lcl_diagnosis {
    uint32_t struct_size;
    double lambda_min_bound;    /**< proven lower bound of the smallest eigenvalue; NaN where none is known (darts, valence 2, rows that are not dominant) */
    double lambda_min_estimate; /**< from a short Lanczos run on the device, never below the bound; of more than 131,072 smooth rows only a sixteenth (65,536 at
                                     least) are looked at, where small diagonal elements crowd; NaN where A is not self-adjoint (darts, rows without D) */
    int32_t singular, indefinite; /**< by exact criterion, or by the estimate */
    char reason[512];             /**< one sentence with the cure, also where A is only nearly singular (estimate below 0.05); "" if all is well */
    int32_t vertices[10], vertex_count;
} lcl_diagnosis;
#define LCL_DIAGNOSIS_INIT \
    { (uint32_t)sizeof(lcl_diagnosis), 0.0, 0.0, 0, 0, "", {0}, 0 }
/** What can be said of the spectrum before solving. Some 20 passes at the first call, on large meshes the time of some five, then remembered. */
LCL_API lcl_status lcl_operator_diagnose(lcl_operator A, lcl_diagnosis* diagnosis);

typedef LCL_ENUM(lcl_precision){LCL_PRECISION_MIXED = 0 /**< float sweeps, residuals and corrections in double or float pairs */, LCL_PRECISION_SINGLE = 1,
                                LCL_PRECISION_DOUBLE = 2} lcl_precision;

/** Limit points, out = A points, through host memory: n x channels, rows `stride` values apart (0: channels). out may be points. One pass, in the given
 * precision. */
LCL_API lcl_status lcl_limit_points(lcl_operator A, const double* points, size_t stride, int32_t channels, lcl_precision precision, double* out,
                                    size_t out_stride);

/* ---------------------------------------------------------------- limit normals and tangents at vertices */

/* The normal of the limit surface at the limit of each vertex, t1 x t2 / |t1 x t2|, outwards where the faces are oriented so. A vertex has one normal a sector,
 * the faces between two sharp edges or all of them; a vertex with several (inner creases, corners) gets their normalised mean, and each of them is a side.
 * Isolated vertices have 0 0 0, as places where the tangents are parallel and creases whose sides cancel. Exact limits (left eigenvectors of the subdivision):
 * - smooth vertices of at least three faces, darts of Catmull-Clark and Loop: both tangents round the vertex;
 * - boundary and crease curves: along and across, Catmull-Clark up to 4 faces a sector, Loop up to 6, Doo-Sabin any; one face: the plane of the two edges;
 * - corners: the plane of the two sharp edges for one face, Loop up to 2, Doo-Sabin any; where the edges form a straight line, what the surface leaves it by.
 * Elsewhere the surface has no tangent plane, or one that shows only infinitely near, and the normal is a choice: curves of more faces and other corners take
 * the tangents along and across that curves have; smooth vertices of two faces E_0 - E_1 and the difference of the faces, corners without two sharp edges
 * and Doo-Sabin's darts the tangents of a smooth vertex.
 * Loop's and Doo-Sabin's surfaces fold over in hollow corners (above 180 degrees), and so do their normals. lambda changes no normal, alpha those of darts
 * alone (lambda 1 leaves no surface to have one, and the one of smaller lambda is given). Vertices outside a subset keep their points and still have the normal
 * of the surface at their limit points. */

/** Makes tangents of all vertices for normals: those of smooth rings use the operator's neighbours, others get stencils of their own, some 50 bytes a
 * neighbour. mesh: the one that A was made of, faces and sharp features unchanged (LCL_ERROR_INVALID_ARGUMENT where vertices differ); points do not matter.
 * Linear time. LCL_ERROR_INVALID_ARGUMENT for operators of your own. */
LCL_API lcl_status lcl_tangents_create(lcl_operator A, lcl_mesh mesh, lcl_tangents* tangents);
LCL_API void lcl_tangents_retain(lcl_tangents tangents);
LCL_API void lcl_tangents_release(lcl_tangents tangents);
/** limit = A x and unit normals, on the device; returns at once. x: points, three channels. All fields are A's, of one precision, and differ; limit may be
 * NULL. tangent and bitangent, both or neither NULL: the rest of an orthonormal frame, the first sector's direction along the curve (curves), to the first edge
 * (else), turned into the plane of the normal, and normal x tangent; with them limit costs a pass of its own. About two passes. Normals and tangents are
 * not centred or scaled; ghosts keep what their rows hold. */
LCL_API lcl_status lcl_tangents_apply(lcl_tangents tangents, lcl_field x, lcl_field limit, lcl_field normals, lcl_field tangent, lcl_field bitangent);
/** Number of sides: sectors of the vertices that have more than one. */
LCL_API int32_t lcl_tangents_side_count(lcl_tangents tangents);
/** Of each side the vertex, the first face in face order (the sector runs on from it to the next sharp edge), and the unit normal that the last
 * lcl_tangents_apply found, for which this waits. Sides of a vertex follow each other. vertices, faces: side_count; normals: side_count x 3; each may be
 * NULL. LCL_ERROR_INVALID_ARGUMENT for normals before the first apply. */
LCL_API lcl_status lcl_tangents_get_sides(lcl_tangents tangents, int32_t* vertices, int32_t* faces, double* normals);
/** The same in one call through host memory. points: vertex_count rows of three, `stride` values apart (0: 3), NULL: the mesh's. limit_points, normals:
 * vertex_count rows of three, limit_stride and normal_stride values apart (0: 3); limit_points may be NULL or points. Normals are exact to some 1e-7 over the
 * length of the edges relative to the diagonal in single precision, to 1e-7 in mixed where the device has no double precision, else to rounding. */
LCL_API lcl_status lcl_limit_normals(lcl_operator A, lcl_mesh mesh, const double* points, size_t stride, lcl_precision precision, double* limit_points,
                                     size_t limit_stride, double* normals, size_t normal_stride);

/* ---------------------------------------------------------------- solving A P = M */

typedef LCL_ENUM(lcl_solver){LCL_SOLVER_AUTO = 0, LCL_SOLVER_PIA = 1,         LCL_SOLVER_WPIA = 2,      LCL_SOLVER_JACOBI = 3,
                             LCL_SOLVER_GS = 4,   LCL_SOLVER_GS_COLOURED = 5, LCL_SOLVER_CHEBYSHEV = 6, LCL_SOLVER_CG = 7} lcl_solver;

/** Progress of a solve; with AUTO and CHEBYSHEV up to 16 iterations are told at once, after they were made. Return 0 to cancel (LCL_ERROR_CANCELLED), anything
 * else to go on. */
typedef int32_t (*lcl_progress_callback)(void* user, int32_t iteration, double residual, double target);

typedef struct lcl_solve_options {
    uint32_t struct_size;
    lcl_solver solver;
    lcl_precision precision;
    double tolerance;       /**< of max_i |R_i| over x, y, z, relative to `diagonal`; 0: 1e-6. Other channels: relative to their own range */
    int32_t max_iterations; /**< 0: 200 */
    int32_t exact_sweeps;   /**< > 0: exactly so many iterations, no test */
    double weight;          /**< W-PIA: 0: the best, from the estimated spectrum; else given, above 0 and below 2 */
    int32_t warm_start;     /**< 1: the output array (or field) holds P_0; 0: P_0 = M */
    int32_t keep_going;     /**< 1: iterate although A is singular or indefinite */
    double diagonal;        /**< model size that the tolerance refers to; 0: the operator's mesh's, or without a mesh that of the box of M */
    lcl_progress_callback progress;
    void* progress_user;
    int32_t certify; /**< 1: also surface_error_bound (where rows are not diagonally dominant, some ten short solves at an operator's first call) */
} lcl_solve_options;
#define LCL_SOLVE_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_solve_options), LCL_SOLVER_AUTO, LCL_PRECISION_MIXED, 0.0, 0, 0, 0.0, 0, 0, 0.0, NULL, NULL, 0 }

typedef struct lcl_solve_report {
    uint32_t struct_size;
    lcl_solver solver;  /**< the one that ran */
    int32_t converged;  /**< max_error <= tolerance x diagonal */
    int32_t iterations; /**< AUTO, CHEBYSHEV and CG solve corners and curves directly first: that counts as the first iteration (not among exact_sweeps) */
    double* residuals;  /**< caller's array or NULL: E_0 .. E_iterations, E_k = max_i |M - A P_k|_i over x, y, z, model units */
    size_t residual_capacity;   /**< its size */
    size_t residual_count;      /**< iterations + 1 */
    double lambda_min;          /**< estimate, NaN if none */
    double max_error;           /**< the final residual recomputed in double, model units */
    double surface_error_bound; /**< with certify: bound of the distance to the exact solution's surface, model units, by the inverse norm
                                     of lcl_operator_inverse_norm; NaN without, and where none is known (darts, rows without D) */
    double channel_error;       /**< the same residual of further channels, relative to their ranges; 0 without */
    double seconds_upload, seconds_solve, seconds_download;
    int32_t vertices[10], vertex_count; /**< where it is singular or indefinite */
    char message[512];                  /**< one sentence if not converged; "" otherwise */
    int32_t changed_rows;               /**< lcl_solve_local: rows of P that were changed; vertex_count where the full solve took over; 0 from others */
} lcl_solve_report;
#define LCL_SOLVE_REPORT_INIT \
    { (uint32_t)sizeof(lcl_solve_report), LCL_SOLVER_AUTO, 0, 0, NULL, 0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, {0}, 0, "", 0 }

/** Control points P with A P = M, through host memory: n x channels each, rows `stride` values apart (0: channels). P may be M.
 *  PIA: P += R (mesh expansion paper; Doo-Sabin paper). W-PIA: P += w R, GS-PIA: newest neighbours (Loop PIA paper). Jacobi: P_i += R_i / A_ii (two-phase
 * paper, eq. 6). Chebyshev and CG: A is self-adjoint under D. AUTO: the fastest that is sure to converge. Vertices outside the subset, corners and isolated
 * ones keep their points. LCL_OK: converged (or exact_sweeps done, on an operator that is not singular or indefinite). LCL_ERROR_SINGULAR, _INDEFINITE,
 * _NOT_CONVERGED: P and report hold what there is. report may be NULL. */
LCL_API lcl_status lcl_interpolate(lcl_operator A, const double* M, size_t stride, int32_t channels, const lcl_solve_options* options, double* P,
                                   size_t P_stride, lcl_solve_report* report);
/** The same on the points of a mesh (which must be the one that A was made from, or one with its faces): replaces them by P. */
LCL_API lcl_status lcl_interpolate_mesh(lcl_operator A, lcl_mesh mesh, const lcl_solve_options* options, lcl_solve_report* report);
/** The same on fields of one operator that stay on the device; P needs no upload unless it is a start. Precision DOUBLE needs fields of doubles, the others
 * take both kinds. */
LCL_API lcl_status lcl_interpolate_field(lcl_operator A, lcl_field M, const lcl_solve_options* options, lcl_field P, lcl_solve_report* report);
/** Moves few vertices of a surface that interpolates: writes `values` (count x channels, model units, the new rows of M for `vertices`, each named once) into M
 * and updates P, which solved A P = M to the tolerance before, to the same tolerance. A^-1 decays exponentially with the distance, so only the surroundings of
 * the edit change: time, transfers and memory follow the edit, not the mesh (10 vertices scattered over a million: about 1 ms, some 100 rows of P for each
 * at an edit of a hundredth of the diagonal). The first call of an operator takes 4 bytes a vertex on the host and a few ms.
 *
 *     lcl_field_create(A, 3, LCL_PRECISION_MIXED, &M);  lcl_field_create(A, 3, LCL_PRECISION_MIXED, &P);
 *     lcl_field_upload(M, points, LCL_TYPE_DOUBLE, 0);
 *     lcl_interpolate_field(A, M, NULL, P, NULL);                                    once
 *     int32_t vertex = 4711;  double point[3] = {0.1, 0.2, 0.3};
 *     lcl_solve_local(A, M, P, &vertex, 1, point, NULL, NULL);                       at every edit; lcl_field_read_vertices reads what is of interest
 *
 * The error does not grow with the number of edits. Residuals are computed in double from the rows as the fields hold them (fields of floats: M and P rounded
 * to float, of which the full solve's max_error speaks too); every row whose residual can have changed ends within tolerance x diagonal, all others read
 * nothing that has changed. So the largest residual of all rows is at most the larger of the tolerance and what it was before, and the distance of P to the
 * exact solution at most |A^-1|_inf times that. Where P was not within the tolerance before, the update goes on as far as that leads. By over-relaxed
 * Gauss-Seidel on the host, on the rows above the tolerance only. The full solve, warm-started, takes over where the operator is singular or indefinite or has
 * rows without D, where more than a sixteenth of the rows (and 4096) would be looked at, and where the iteration is slow (AUTO: 100 sweeps); then changed_rows
 * is vertex_count. options: solver is AUTO or GS, exact_sweeps 0; precision as for lcl_interpolate_field; warm_start, weight and certify are not looked at but
 * by the full solve. report: max_error over the rows whose residual can have changed, iterations are sweeps, seconds_download and _upload the transfers of
 * single rows. Vertices that keep their points (corners, outside the subset, isolated) take the new ones in P as they are. Edits far beyond the model's size
 * need fields of doubles: the scale of floats is that of the first upload. Errors and results as those of lcl_interpolate_field. Fields are as before if an
 * argument is refused, and, unless the full solve has begun, if progress cancels. */
LCL_API lcl_status lcl_solve_local(lcl_operator A, lcl_field M, lcl_field P, const int32_t* vertices, size_t count, const double* values,
                                   const lcl_solve_options* options, lcl_solve_report* report);
/** lcl_interpolate on a thread of its own: arrays, options and report must live until lcl_task_wait. The context is busy until then. */
LCL_API lcl_status lcl_interpolate_async(lcl_operator A, const double* M, size_t stride, int32_t channels, const lcl_solve_options* options, double* P,
                                         size_t P_stride, lcl_solve_report* report, lcl_task* task);
/** Waits, and gives the status of the call itself (with its sentence in lcl_last_error of this thread). */
LCL_API lcl_status lcl_task_wait(lcl_task task);
LCL_API int32_t lcl_task_is_done(lcl_task task);
/** Waits, then frees. */
LCL_API void lcl_task_release(lcl_task task);

/** |A^-1|_inf of the smooth block, for error bounds: 1/min(2 a_ii - 1) where rows are diagonally dominant (then `proven` is 1), else estimated by block
 * Hager-Higham (a few solves at the first call, then remembered; an estimate lies below the norm, by a few percent as a rule; NaN where the solves do not end).
 * LCL_ERROR_UNSUPPORTED where A has no self-adjoint form (darts; rows without D, unless they are dominant). */
LCL_API lcl_status lcl_operator_inverse_norm(lcl_operator A, double* norm, int32_t* proven);

/* ---------------------------------------------------------------- fields: values that stay on the device */

/** n x channels values in the operator's own order and units, on its device; zero at first. precision MIXED and SINGLE store floats, DOUBLE doubles. The
 * first solve of a shape makes up to three working fields of its size, which the operator keeps for the next one. LCL_ERROR_MEMORY, with the numbers, if the
 * device has no room. */
LCL_API lcl_status lcl_field_create(lcl_operator A, int32_t channels, lcl_precision precision, lcl_field* field);
LCL_API void lcl_field_retain(lcl_field field);
LCL_API void lcl_field_release(lcl_field field);
LCL_API int32_t lcl_field_channels(lcl_field field);
/** Host to device and back: n rows in the caller's vertex order, `stride` values apart (0: channels). upload returns when `values` may be changed; download
 * when they are there. The first upload of a field sets the centre and scale that its floats are kept in (lcl_field_match: those of another field). */
LCL_API lcl_status lcl_field_upload(lcl_field field, const void* values, lcl_type type, size_t stride);
LCL_API lcl_status lcl_field_download(lcl_field field, void* values, lcl_type type, size_t stride);
/** Gives `field` the centre and scale of `of`, so that both can stand in one formula: before its first upload, or where they are the same. `of` may belong to
 * another operator. Where the rows of the field's operator do not sum to 1, its centre is 0, and another one is refused. */
LCL_API lcl_status lcl_field_match(lcl_field field, lcl_field of);
/** Single rows by vertex: count x channels, doubles. For halo exchange between the parts of a cluster. */
LCL_API lcl_status lcl_field_read_vertices(lcl_field field, const int32_t* vertices, size_t count, double* values);
LCL_API lcl_status lcl_field_write_vertices(lcl_field field, const int32_t* vertices, size_t count, const double* values);

/** y = A x: limit points. Enqueued; lcl_context_finish or a download waits. Ghost rows of y are not touched. x and y must differ. One pass. */
LCL_API lcl_status lcl_operator_apply(lcl_operator A, lcl_field x, lcl_field y);
/** y = a x + b (M - A x) + c d on rows [first_block, first_block + block_count) of lcl_operator_block_count (block_count < 0: all), and, if residual is not
 * NULL, waits for max_i |M - A x|_i over those rows and x, y, z, model units. d may be NULL if c is 0, or y. x and y must differ. M, x and d must share centre
 * and scale (lcl_field_match). PIA: a = b = 1; W-PIA: a = 1, b = w; residual: a = 0, b = 1. One pass. Rows that are fixed (corners, outside the subset,
 * isolated) have A x = x. */
LCL_API lcl_status lcl_operator_step(lcl_operator A, double a, double b, double c, lcl_field M, lcl_field x, lcl_field d, lcl_field y, int32_t first_block,
                                     int32_t block_count, double* residual);
LCL_API int32_t lcl_operator_block_count(lcl_operator A);

/* ---------------------------------------------------------------- refinement */

typedef struct lcl_refine_options {
    uint32_t struct_size;
    int32_t levels; /**< 0: 1; below 0: none (a copy with locations) */
} lcl_refine_options;
#define LCL_REFINE_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_refine_options), 0 }

/** Refines uniformly, in double on all cores of the host. alpha_auto, subset and owned are not looked at. alpha and lambda rule the first refinement alone
 * (lambda: the two-phase first step, which gives the mesh M^1); the result is read with alpha 0 and lambda 0, and carries refined creases and corners. Colours
 * and scalar properties are refined as channels; texture coordinates are dropped with a note. */
LCL_API lcl_status lcl_mesh_refine(lcl_mesh mesh, const lcl_scheme_options* scheme, const lcl_refine_options* options, lcl_mesh* refined);
/** Where each vertex of a refined mesh lies on the original's surface, in the parameters of `limitcl evaluate`: faces (-1: isolated) and corners: vertex_count;
 * uv: vertex_count x 2. */
LCL_API lcl_status lcl_mesh_get_locations(lcl_mesh refined, int32_t* faces, int32_t* corners, double* uv);

/** The topology of a refinement, made once for values that change: points of every frame, colours, other channels. context: the device that
 * lcl_refiner_apply uses; NULL: the host, in double. Options, time and errors as lcl_mesh_refine; the refiner keeps what it needs of the mesh's faces and
 * features as they are now, and the mesh: about 110 bytes a vertex of the mesh before the last level (on the device 60), and four a corner of the refined one.
 */
LCL_API lcl_status lcl_refiner_create(lcl_context context, lcl_mesh mesh, const lcl_scheme_options* scheme, const lcl_refine_options* options,
                                      lcl_refiner* refiner);
LCL_API void lcl_refiner_retain(lcl_refiner refiner);
LCL_API void lcl_refiner_release(lcl_refiner refiner);
/** Number of refined vertices. */
LCL_API int32_t lcl_refiner_vertex_count(lcl_refiner refiner);
/** What lcl_mesh_refine gives, with the points and properties that the mesh has now (in double on the host). */
LCL_API lcl_status lcl_refiner_get_mesh(lcl_refiner refiner, lcl_mesh* refined);
/** Refined values in the order of refined vertices. values: n x channels, n the vertices of the mesh, rows `stride` values apart (0: channels); out: the
 * refined vertices x channels, `out_stride` values apart (0: channels), which may not overlap with values. precision: of the sums, as for lcl_limit_points; on
 * the device values are centred and scaled, SINGLE loses about 1e-7 of their size a level. LCL_ERROR_BAD_INPUT for values that are not finite,
 * LCL_ERROR_MEMORY where the device has no room. What lies between the levels stays on the device for the next call. */
LCL_API lcl_status lcl_refiner_apply(lcl_refiner refiner, const double* values, size_t stride, int32_t channels, lcl_precision precision, double* out,
                                     size_t out_stride);

/* ---------------------------------------------------------------- the two-phase scheme: tangent planes, shape handles, fairness */

typedef struct lcl_two_phase_options {
    uint32_t struct_size;
    int32_t skip_normals;        /**< 1: normals that cannot be asked for are left out and counted, instead of refused */
    const double* normals;       /**< NULL, or vertex_count x 3: the normal that the surface is to have at each vertex, of any length above 0; 0 0 0: free */
    const double* handles;       /**< NULL, or one shape handle S > 0 a vertex; rules over the next two */
    double convex_handle;        /**< S of convex vertices, 0: 1. A vertex is convex where the angle inside the solid is below 180 degrees at every edge */
    double other_handle;         /**< S of the others, 0: 1 */
    double fair;                 /**< W, weight of fairness; 0: none. 1 takes most bumps out, 100 nearly all that the constraints allow */
    const char* const* channels; /**< NULL, or names of channel_count properties that are interpolated like x, y, z; the others are only refined */
    size_t channel_count;
} lcl_two_phase_options;
#define LCL_TWO_PHASE_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_two_phase_options), 0, NULL, NULL, 0.0, 0.0, 0.0, NULL, 0 }

typedef struct lcl_two_phase_report {
    uint32_t struct_size;
    int32_t normal_count;     /**< normals that the surface has now */
    int32_t skipped_normals;  /**< left out, with skip_normals */
    int32_t scaled_normals;   /**< that were not of unit length */
    int32_t wrong_side_count; /**< normals on the other side of the surface than the one it had without them: it may fold there */
    int32_t wrong_side[10];   /**< the first of these vertices */
    int32_t convex_count;     /**< convex vertices; counted where convex_handle and other_handle differ */
    int32_t fair_iterations;  /**< of conjugate gradients, 1000 at most */
    int32_t fair_converged;   /**< 1: their residual fell to 1e-8 of what it was at first; 0: what 1000 of them gave */
    double largest_repair;    /**< largest distance from a vertex to its limit point before the repair, model units */
    double max_error;         /**< the same in the result: rounding */
    double energy[2];         /**< |L X|^2 before and after fairness, squares of model units; NaN without */
    double seconds;           /**< of all but the solve */
} lcl_two_phase_report;
#define LCL_TWO_PHASE_REPORT_INIT \
    { (uint32_t)sizeof(lcl_two_phase_report), 0, 0, 0, 0, {0}, 0, 0, 0, 0.0, 0.0, {0.0, 0.0}, 0.0 }

/** Refined control mesh M^1 whose Catmull-Clark surface passes through the vertices Q of `mesh` exactly, however far the solve went (two-phase paper):
 * 1. A_lambda P = Q is solved, and M^1 made of P by the first refinement with lambda (lcl_mesh_refine). In it every vertex of `mesh` has an umbrella, its edge
 *    and face points, that no other vertex has a part in. All that follows is done umbrella by umbrella.
 * 2. Position repair, eq. 7: the least change that brings the limit point to Q.
 * 3. Tangent planes, eq. 15: the least change that makes the plane at the limit point orthogonal to the normal N. (Source slip: the scanned text gives its two
 *    tangents the same weights.) At boundary vertices by their own masks. A normal can be asked for at vertices without a sharp edge and three faces or more,
 *    and on boundary curves with 2 to 4 faces; not at corners, on creases and their ends, and outside the subset. Where (t1 x t2).N <= 0 before, the surface
 *    has to turn over: wrong_side tells.
 * 4. Fairness: X that minimises |X - X_0|^2 + W |L X|^2 under the same constraints, X_0 the repaired M^1 and L its umbrella Laplacian (mean of the edge
 *    neighbours minus the vertex; on boundary and crease curves, of those along the curve; no row at corners). Some 20 to 100 iterations.
 * 5. Shape handles: X -> Q + S (X - Q) in every umbrella: S < 1 sharpens, a large S makes a flat spot. Limit points and tangent planes stay. They come last,
 *    so that S is what it says on a fair surface; energy[1] is that before them.
 * The result is read with alpha 0 and lambda 0. Vertex i of `mesh` is vertex i of M^1, whose order lcl_mesh_refine has. It carries refined creases and corners,
 * and properties; texture coordinates are dropped with a note. Vertices outside the subset of A are not constrained.
 * A: of `mesh` or one with its faces, Catmull-Clark with lambda above 0 and below 1 at every vertex (else LCL_ERROR_INVALID_ARGUMENT). `mesh` is not changed.
 * solve: as for lcl_interpolate, but warm_start; its progress is also called by fairness, whose residuals go in model units. LCL_OK also where the solve did
 * not converge, as solve_report tells, but did not run away either (to ten times its first residual); LCL_ERROR_SINGULAR, _INDEFINITE, _NOT_CONVERGED
 * otherwise, and `refined` is only made with keep_going. LCL_ERROR_BAD_INPUT, with the vertex, for a normal that cannot be asked for. Reports may be NULL. On
 * devices without double precision steps 2 to 5 run on the host. Linear time but for the solve; some 250 bytes a vertex of M^1 (of which quads make nine of
 * one), 50 more with fairness. */
LCL_API lcl_status lcl_two_phase_mesh(lcl_operator A, lcl_mesh mesh, const lcl_solve_options* solve, const lcl_two_phase_options* options, lcl_mesh* refined,
                                      lcl_solve_report* solve_report, lcl_two_phase_report* report);
/** For each vertex of the mesh that a two-phase mesh was made from, the vertex of M^1 at whose limit point it lies: its own number, isolated ones too.
 * vertices: as many as that mesh had, which is what `count` receives; NULL: count alone. LCL_ERROR_INVALID_ARGUMENT for a mesh that lcl_two_phase_mesh did not
 * make. */
LCL_API lcl_status lcl_two_phase_get_map(lcl_mesh refined, int32_t* vertices, size_t* count);

/* ---------------------------------------------------------------- operators of your own */

/** Rows of a matrix A of the caller's: row i holds weights[offsets[i]] .. weights[offsets[i + 1] - 1] at columns[..], each column at most once, the diagonal
 * among them, which is not 0. Rows of one entry, 1, are identity rows: their points stay. */
typedef struct lcl_rows {
    uint32_t struct_size;
    int32_t row_count;
    const int64_t* offsets; /**< row_count + 1, from 0 on */
    const int32_t* columns; /**< offsets[row_count] */
    const double* weights;  /**< as many */
    const double* scaling; /**< NULL, or D: row_count numbers above 0 with diag(D) A symmetric (identity rows, and columns of them, are left out of that), which
                                CG and GS, energies and even morphs need */
} lcl_rows;
#define LCL_ROWS_INIT \
    { (uint32_t)sizeof(lcl_rows), 0, NULL, NULL, NULL, NULL }

/** An operator from rows instead of a mesh: solves, series, filters and morphs take it like any other (mesh expansion paper, section 9: A may be any matrix
 * with eigenvalues in (0, 1]). Checked here: arrays, finite weights, symmetry of diag(D) A (to 1e-12 of its largest element), and the spectrum, by proof where
 * the rows allow one (Gershgorin) and else by an Arnoldi run of some 30 steps (in double on the host; without D a few seconds for a million rows).
 * LCL_ERROR_BAD_INPUT with the row where an array is wrong or D A is not symmetric; LCL_ERROR_UNSUPPORTED where an eigenvalue above 1, below 0 or not real was
 * found. An eigenvalue of 0 is no failure here: interpolation reports it as LCL_ERROR_SINGULAR. Without D: CG and GS are refused (LCL_ERROR_INVALID_ARGUMENT),
 * residuals may grow before they fall, and lcl_solve_local solves the whole. Where rows do not sum to 1, constants are no fixed points of the filters, and
 * fields keep values round 0: far from it, floats lose digits. tolerance x diagonal of solves refers to the bounding box of M. */
LCL_API lcl_status lcl_operator_create_rows(lcl_context context, const lcl_rows* rows, lcl_operator* A);

typedef struct lcl_feature_options {
    uint32_t struct_size;
    double angle_degrees;   /**< 0: 20. Angle between the tangent planes at an edge's ends at which its weight has fallen to 1/e, at most 180 */
    double diagonal_factor; /**< 0: 2.5. D_ii = factor x sum of the weights at i; above 2, so that eigenvalues lie in [1 - 2 / factor, 1] */
    int32_t smoothing;      /**< 0: 3; below 0: none; at most 1000. Applications of (E - (E - A)^3) A, A of the default scheme, to the points from which the
                                 tangent planes are taken */
    const int32_t* subset;  /**< NULL, or the vertices that the filter may move: the others keep their points (identity rows) */
    size_t subset_count;
} lcl_feature_options;
#define LCL_FEATURE_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_feature_options), 0.0, 0.0, 0, NULL, 0 }

/** A feature-preserving operator of a mesh, A = D^-1 (D - L_w), L_w the graph Laplacian of the edges with weights that fall with the angle between the tangent
 * planes at their ends: exp(-(angle / angle_degrees)^2). Vertices along a sharp edge hold together, and vertices beside it hardly pull at them. Vertices of
 * boundary and crease curves hold to their neighbours on the curve alone; corners and vertices outside `subset` stay, and so do those whose weights are all 0.
 * For denoising: it is no limit operator. */
LCL_API lcl_status lcl_operator_create_features(lcl_context context, lcl_mesh mesh, const lcl_feature_options* options, lcl_operator* A);

/* ---------------------------------------------------------------- mesh expansion, and what it is good for */

/* A mesh M is the sum of its terms (E - A)^i A M (mesh expansion paper, eq. 6): low i are its low frequencies. Term i passes an eigenvalue mu of A with gain
 * mu (1 - mu)^i, largest at mu = 1 / (i + 1), so neighbouring terms overlap and 0, 1, 2-3, 4-7, 8-15 are useful bands. Each term is a mesh with the faces of M,
 * and can be expanded again. D stands for E - (E - A)^(m + 1) here, the sum of the terms 0 to m.
 *
 * Functions come in two kinds: through host memory (n x channels, rows `stride` values apart, 0: channels; `out` may be the input), computed in double or pairs
 * of floats under LCL_PRECISION_MIXED and LCL_PRECISION_DOUBLE; and on fields that stay on the device (which must differ), computed in the fields' own type,
 * enqueued without waiting (lcl_spectrum_field waits, and so does all that is given a progress
 * callback or more than 1024 passes). LCL_PRECISION_DOUBLE is refused on devices without double precision (LCL_ERROR_UNSUPPORTED). Corners, isolated vertices
 * and those outside the subset have A x = x: they are kept, or become 0 in terms that do not hold them. They need no inverse: singular operators do as well.
 * Operators with ghosts are refused (LCL_ERROR_UNSUPPORTED). */

/** Passes done of all. Return 0 to cancel (LCL_ERROR_CANCELLED, outputs are as before), anything else to go on. */
typedef int32_t (*lcl_pass_callback)(void* user, int64_t done, int64_t all);

typedef LCL_ENUM(lcl_series){
    LCL_SERIES_REPRESENTATION = 0, /**< terms (E - A)^i A M, which sum to M; partial sums smooth */
    LCL_SERIES_INTERPOLATION = 1   /**< terms (E - A)^i M, which sum to P with A P = M; partial sums (the iterates of PIA) sharpen */
} lcl_series;

typedef struct lcl_expand_options {
    uint32_t struct_size;
    lcl_series series;
    lcl_precision precision;
    int32_t first, last;   /**< the sum of the terms first..last, 0 <= first <= last <= 100000; equal: one term */
    const double* weights; /**< NULL, or weights of the terms 0 .. weight_count - 1: an equaliser. Rule over first and last */
    size_t weight_count;
    double remainder; /**< with weights, representation series: weight of what the terms leave, (E - A)^weight_count M; 1 in the _INIT: all ones give M back */
    lcl_pass_callback progress;
    void* progress_user;
} lcl_expand_options;
#define LCL_EXPAND_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_expand_options), LCL_SERIES_REPRESENTATION, LCL_PRECISION_MIXED, 0, 0, NULL, 0, 1.0, NULL, NULL }

/** A weighted sum of terms; out in the units of M, terms that leave out the first one round the origin. Terms i to j take j + 1 passes, n weights n at most;
 * one less in the interpolation series. No term is stored: three fields. */
LCL_API lcl_status lcl_expand(lcl_operator A, const double* M, size_t stride, int32_t channels, const lcl_expand_options* options, double* out,
                              size_t out_stride);
LCL_API lcl_status lcl_expand_field(lcl_operator A, lcl_field M, const lcl_expand_options* options, lcl_field out);

/** Energies of the terms T_0 .. T_(term_count - 1) of the representation series, channel by channel: sum D_ii (T_i - mean)^2 / sum D_ii, D here the scaling
 * that makes D A symmetric, mean its weighted mean; isolated vertices are left out. energies: term_count x channels, squares of model units. One pass a term.
 * LCL_ERROR_INVALID_ARGUMENT on rows without D. */
LCL_API lcl_status lcl_spectrum(lcl_operator A, const double* M, size_t stride, int32_t channels, lcl_precision precision, int32_t term_count,
                                double* energies);
LCL_API lcl_status lcl_spectrum_field(lcl_operator A, lcl_field M, int32_t term_count, double* energies);

typedef struct lcl_denoise_options {
    uint32_t struct_size;
    lcl_precision precision;
    int32_t m;     /**< 0 to 100000; 2 in the _INIT. Small m: smoother, less detail */
    int32_t k;     /**< 0 to 100000; 3 in the _INIT */
    int32_t plain; /**< 1: D^k instead of D^k A */
    lcl_pass_callback progress;
    void* progress_user;
} lcl_denoise_options;
#define LCL_DENOISE_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_denoise_options), LCL_PRECISION_MIXED, 2, 3, 0, NULL, NULL }

/** T = D^k A M (mesh expansion paper, eq. 8, with T_0 the limit mesh A M), or plain D^k M (source slip: the paper writes both). k (m + 1) + 1 passes, plain
 * k (m + 1). On closed meshes T shrinks to one point a component as k grows: lcl_mesh_match_volume restores volumes. */
LCL_API lcl_status lcl_denoise(lcl_operator A, const double* M, size_t stride, int32_t channels, const lcl_denoise_options* options, double* out,
                               size_t out_stride);
LCL_API lcl_status lcl_denoise_field(lcl_operator A, lcl_field M, const lcl_denoise_options* options, lcl_field out);
/** m and k in plain words, by tenths: strength 0 (k = 0: nothing but A, or nothing at all where plain) to 1 (m = 1, k = 100), 0.5 the default m = 2, k = 3; the
 * more, the smoother. For noise of 0.1 mean edge lengths about 0.8, of 0.2 to 0.3 0.9, of more 1. */
LCL_API lcl_status lcl_denoise_settings(double strength, int32_t* m, int32_t* k);
/** Moves the points of every closed component along their normals (area-weighted), all by one distance, until the component encloses the volume that it had
 * with `points` (vertex_count rows of three, `stride` values apart, 0: 3). Corners and `fixed` vertices stay. A component that keeps no volume, or cannot reach
 * the old one, stays as it is, with a note of kind LCL_NOTE_WARNING. LCL_ERROR_BAD_INPUT on a mesh with a boundary: it encloses nothing. */
LCL_API lcl_status lcl_mesh_match_volume(lcl_mesh mesh, const double* points, size_t stride, const int32_t* fixed, size_t fixed_count);
/** Volume that the faces enclose (fans round each face's mean; positive where they look outwards). LCL_ERROR_BAD_INPUT with a boundary. */
LCL_API lcl_status lcl_mesh_get_volume(lcl_mesh mesh, double* volume);

typedef struct lcl_sharpen_options {
    uint32_t struct_size;
    lcl_precision precision;
    int32_t first, last; /**< terms first..last are added, 1 <= first <= last <= 100000; 1 and 3 in the _INIT */
    int32_t k;           /**< times, at least 1; 1 in the _INIT */
    lcl_pass_callback progress;
    void* progress_user;
} lcl_sharpen_options;
#define LCL_SHARPEN_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_sharpen_options), LCL_PRECISION_MIXED, 1, 3, 1, NULL, NULL }

/** T_(k + 1) = T_k + sum (E - A)^i T_k over first..last (mesh expansion paper, section 6). k x last passes. An eigenvalue mu gains 1 + sum (1 - mu)^i a step,
 * by design without limit in k: at most (last - first + 2)^k in the D norm, which is the bound against blow-up: settings with more than 10^6 are refused
 * (LCL_ERROR_INVALID_ARGUMENT). */
LCL_API lcl_status lcl_sharpen(lcl_operator A, const double* M, size_t stride, int32_t channels, const lcl_sharpen_options* options, double* out,
                               size_t out_stride);
LCL_API lcl_status lcl_sharpen_field(lcl_operator A, lcl_field M, const lcl_sharpen_options* options, lcl_field out);

typedef LCL_ENUM(lcl_morph_path){
    LCL_MORPH_RECURSION = 0, /**< m and rho as given */
    LCL_MORPH_EVEN = 1,      /**< rho of each frame for equal steps, the last frame is the target itself */
    LCL_MORPH_LINEAR = 2     /**< straight lines, for comparison */
} lcl_morph_path;

typedef struct lcl_morph_options {
    uint32_t struct_size;
    lcl_precision precision;
    lcl_morph_path path;
    int32_t frames;   /**< N, 1 to 1000000; 0: 10. Frames 0 (the start) to N are given out */
    const int32_t* m; /**< m of the step to frame 1, 2, ..; the last is repeated; NULL: 2. 0 to 100000 */
    size_t m_count;
    const double* rho; /**< likewise, above 0 and up to 1; NULL: 0.5. Not with EVEN */
    size_t rho_count;
} lcl_morph_options;
#define LCL_MORPH_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_morph_options), LCL_PRECISION_MIXED, LCL_MORPH_RECURSION, 0, NULL, 0, NULL, 0 }

/** points: n x channels, valid during the call, which may change them. Return 0 to cancel (LCL_ERROR_CANCELLED). */
typedef int32_t (*lcl_frame_callback)(void* user, int32_t frame, double* points);

/** Q_0 = from; Q_(k + 1) = to + rho D (Q_k - to) (mesh expansion paper, eq. 9; source slip: Q_k tends to `to` for rho < 1 only, for rho = 1 to a translation of
 * it). EVEN: rho_k = min(1, (1 - (k + 1)/N) |Q_0 - to|_D / |D (Q_k - to)|_D) over x, y, z, the last 0; where the 1 cuts, early steps are longer. The flat
 * middle shape of a mirror pair is not avoided. m + 1 passes a frame. from, to: n x channels, rows `stride` values apart (0: channels), model units. A belongs
 * to `from` or any mesh with its faces. LCL_ERROR_INVALID_ARGUMENT for options out of range, and for EVEN on rows without D; LCL_ERROR_BAD_INPUT for values
 * that are not finite. */
LCL_API lcl_status lcl_morph(lcl_operator A, const double* from, const double* to, size_t stride, int32_t channels, const lcl_morph_options* options,
                             lcl_frame_callback frame, void* user);
/** One step on fields, for frames that stay on the device: difference becomes rho D difference, and frame to + difference. The first difference comes from
 * lcl_field_subtract(from, to, difference); LCL_ERROR_INVALID_ARGUMENT for another one, and for fields of different operators, shapes or types. */
LCL_API lcl_status lcl_morph_field(lcl_operator A, int32_t m, double rho, lcl_field to, lcl_field difference, lcl_field frame);
/** difference = a - b, of one operator, centre and scale (lcl_field_match); difference may be neither. */
LCL_API lcl_status lcl_field_subtract(lcl_field a, lcl_field b, lcl_field difference);
/** LCL_OK where two meshes have the same faces, vertex by vertex; else LCL_ERROR_BAD_INPUT with the first difference. */
LCL_API lcl_status lcl_mesh_compare_faces(lcl_mesh a, lcl_mesh b);

typedef struct lcl_texture_options {
    uint32_t struct_size;
    int32_t octaves;  /**< 0: 4; at most 20 */
    int32_t levels;   /**< K refinements of the result, octaves - 1 at least; 0: so many */
    double frequency; /**< F, noise cells across the diagonal of the bounding box in the first octave; 0: 8. At most 2^32 in the last one */
    uint32_t seed;
    const double* colours; /**< colour_count x (red, green, blue) from 0 to 1; NULL: five of marble */
    size_t colour_count;
    lcl_precision precision;        /**< of the noise and of the solves; points are always taken to the limit in double or pairs of floats */
    double tolerance;               /**< of the solves, relative to the range of the noise; 0: 1e-6 */
    int32_t max_iterations;         /**< 0: 200 */
    int32_t keep_going;             /**< 1: take what the solves give although A is singular, indefinite or they did not converge; the status says so */
    lcl_progress_callback progress; /**< of the solves */
    void* progress_user;
} lcl_texture_options;
#define LCL_TEXTURE_OPTIONS_INIT \
    { (uint32_t)sizeof(lcl_texture_options), 0, 0, 0.0, 0, NULL, 0, LCL_PRECISION_MIXED, 0.0, 0, 0, NULL, NULL }

/** Procedural texture by interpolated octaves (mesh expansion paper, section 5): octave i is improved Perlin noise f(2^i p)/2^i at the vertices p of the mesh
 * refined i times, p = F (x - centre)/diagonal + an offset from the seed, which is far from whole numbers in every octave; each octave is interpolated by a
 * limit surface of its own, all are added on the mesh refined `levels` times, at its limit points, and normalised to t in [0, 1] (1/2 where all is one).
 * `textured` is that mesh at its limit points, with the property "noise" (t) and colours red, green, blue (whole numbers from 0 to 255, as PLY files have them)
 * from a cubic B-spline through the colours, colour j at t = j/(colour_count - 1), natural ends, clamped to [0, 1]. They replace properties of these names;
 * others are refined and taken to the limit too. Texture coordinates are dropped with a note, as by lcl_mesh_refine, whose order of vertices it has
 * (Catmull-Clark and Loop: those of `mesh` come first, with the colours for `mesh` itself). The same seed gives the same texture: to the bit on one device, to
 * the tolerance on others. alpha and lambda rule the first refinement alone. `scheme`: as for lcl_operator_create, where alpha_auto looks at `mesh` itself,
 * vertices outside the subset keep their noise as control values, and owned is refused. report (may be NULL): of the worst solve, the one with the largest
 * error for its tolerance; lengths are values of noise. LCL_ERROR_SINGULAR, _INDEFINITE, _NOT_CONVERGED: the sentence names the octave (vertices are numbered
 * as in its mesh), and nothing is given out unless keep_going is set. LCL_ERROR_MEMORY, with the number and before anything large is made, where the levels do
 * not fit. Costs `octaves` solves of one channel, `levels` refinements on the host and one pass. */
LCL_API lcl_status lcl_texture(lcl_context context, lcl_mesh mesh, const lcl_scheme_options* scheme, const lcl_texture_options* options, lcl_mesh* textured,
                               lcl_solve_report* report);

/* ---------------------------------------------------------------- the limit surface itself */

/* Places on the surface are (face, corner, u, v), face and corner of the mesh:
 * - Catmull-Clark, quads: corner 0; (u, v) in [0, 1]^2 runs over the whole face, (0, 0) at its first vertex, u towards the second, v towards the last.
 * - Catmull-Clark, other faces: the sub-quad at `corner`: (0, 0) at that vertex, (1, 0) the middle of the edge to the next vertex, (0, 1) the middle of the
 *   edge to the previous one, (1, 1) the face's centre.
 * - Loop: corner 0; barycentric weights (1 - u - v, u, v) on the face's three vertices, u, v >= 0, u + v <= 1 (1e-12
 *   outside is taken to be on the border).
 * - Doo-Sabin: the patch of the vertex that the first refinement makes at `corner` of the face: (0, 0) the centre of the new face at the old vertex, (1, 0) of
 *   the one on the edge to the next vertex, (0, 1) of the one on the edge to the previous vertex, (1, 1) of the one inside the old face. Where the edge to the
 *   next vertex is sharp (boundary or crease), v runs from -1, the curve, to 1; where the one to the previous vertex is, u does.
 * In all of them S_u x S_v points outwards. */

/** Patches of the limit surface: regular ones are B-splines (Catmull-Clark bicubic, Doo-Sabin biquadratic) or box splines (Loop), those at extraordinary
 * vertices and faces are infinite sequences of such, evaluated by the eigenstructure of the local subdivision (Stam 1998); at sharp features by its powers.
 * Exact everywhere: no patch is replaced by another. alpha rules the first refinement, which is made explicitly. Time and memory linear in the mesh, but that a
 * vertex with k faces at a sharp feature takes k^3 (some 100 faces: seconds); the eigenstructures of the valences that occur are computed once a process.
 * precision: that of control points and evaluation; MIXED is double where the device has it. The mesh's points are the first control points. Evaluation takes a
 * few nanoseconds a point. LCL_ERROR_INVALID_ARGUMENT for lambda (a two-phase surface is evaluated through its mesh M^1), alpha_auto, subset and owned. */
LCL_API lcl_status lcl_limit_surface_create(lcl_context context, lcl_mesh mesh, const lcl_scheme_options* scheme, lcl_precision precision,
                                            lcl_limit_surface* surface);
LCL_API void lcl_limit_surface_retain(lcl_limit_surface surface);
LCL_API void lcl_limit_surface_release(lcl_limit_surface surface);
/** New control points for the same faces: vertex_count rows of three, `stride` values apart (0: 3). Samples that were made before give values on the new
 * surface from then on. */
LCL_API lcl_status lcl_limit_surface_set_points(lcl_limit_surface surface, const double* points, size_t stride);

/** Where values of a surface go. Arrays of the caller, packed, each NULL where it is not wanted; `type` is that of all. Units: model units by parameter. At an
 * extraordinary point itself the derivatives by (u, v) do not exist: du and dv are unit limit tangents along the patch's two sides there, second derivatives
 * and curvatures NaN. Where the surface has no tangent plane or a first derivative vanishes, what depends on it is NaN. */
typedef struct lcl_surface_values {
    uint32_t struct_size;
    lcl_type type;
    void* points;          /**< count x 3 */
    void *du, *dv;         /**< count x 3: first derivatives */
    void* normals;         /**< count x 3: unit, du x dv */
    void *duu, *duv, *dvv; /**< count x 3: second derivatives */
    void* gauss;           /**< count: Gaussian curvature */
    void* mean;            /**< count: mean curvature, positive where the surface bends away from the outward normal (1/r on a sphere) */
} lcl_surface_values;
#define LCL_SURFACE_VALUES_INIT \
    { (uint32_t)sizeof(lcl_surface_values), LCL_TYPE_DOUBLE, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL, NULL }

/** Finds the patches of `count` places and keeps them on the device, sorted by kind of patch: 20 to 28 bytes a place. faces: count; corners: count, NULL: all
 * 0; uv: count x 2. LCL_ERROR_BAD_INPUT names the first place (by its index in the arrays, from 0) whose face, corner or (u, v) does not exist. */
LCL_API lcl_status lcl_samples_create(lcl_limit_surface surface, size_t count, const int32_t* faces, const int32_t* corners, const double* uv,
                                      lcl_samples* samples);
LCL_API void lcl_samples_retain(lcl_samples samples);
LCL_API void lcl_samples_release(lcl_samples samples);
/** Values at all samples, in their order. */
LCL_API lcl_status lcl_samples_evaluate(lcl_samples samples, const lcl_surface_values* values);
/** The same in one call, piece by piece, so that memory does not grow with `count`. */
LCL_API lcl_status lcl_limit_surface_evaluate(lcl_limit_surface surface, size_t count, const int32_t* faces, const int32_t* corners, const double* uv,
                                              const lcl_surface_values* values);

/** Closest points, each array the caller's or NULL. */
typedef struct lcl_closest_points {
    uint32_t struct_size;
    int32_t *faces, *corners; /**< count */
    double* uv;               /**< count x 2 */
    double* points;           /**< count x 3 */
    double* normals;          /**< count x 3: unit; NaN where there is none */
    double* distances;        /**< count: signed, positive on the normal's side */
} lcl_closest_points;
#define LCL_CLOSEST_POINTS_INIT \
    { (uint32_t)sizeof(lcl_closest_points), NULL, NULL, NULL, NULL, NULL, NULL }

/** For each of `count` points (rows of three, `stride` values apart, 0: 3) the closest point of the limit surface: from the nearest of places that lie equally
 * far apart on the surface Newton on the exact surface, across patch borders, until a step is shorter than 1e-12 of the surface's size (in single precision
 * 1e-7); where the point stays farther away than a twentieth of what lies between two such places, from up to eleven more of them. A point of the boundary
 * counts where nothing nearer is. Where the surface folds more closely than these places lie (an edge of a face at most), a neighbouring local minimum may be
 * found. A distance to a point without a normal is positive. LCL_ERROR_BAD_INPUT for points that are not finite or more than 1e12 times as far away as the
 * surface is large. */
LCL_API lcl_status lcl_limit_surface_closest(lcl_limit_surface surface, size_t count, const double* points, size_t stride, const lcl_closest_points* closest);

/* ---------------------------------------------------------------- surfaces from point clouds */

/** Points, and what may stand beside them: normals, colours. Copies what it is given. points: count rows of three, `stride` values apart (0: 3); normals: NULL,
 * or as many, of any length above 0, outwards. At most 2^31 - 1 points. LCL_ERROR_BAD_INPUT names the first that is not finite, or whose normal is zero. */
LCL_API lcl_status lcl_cloud_create(size_t count, const double* points, size_t stride, const double* normals, size_t normal_stride, lcl_cloud* cloud);
/** Reads points. .ply .off .obj: the vertices, with nx ny nz, the normals of NOFF, or vn (the mean of those of a vertex's corners; without faces the i-th is
 * that of vertex i), and colours. .xyz: a point a line, x y z [nx ny nz] [r g b]; blanks, commas or semicolons between numbers, as many numbers in every line,
 * # before a comment. Three columns are colours where they hold whole numbers from 0 to 255, one of them above 1, or numbers from 0 to 1 that are no unit
 * vectors; else normals. .pts: the same after a line with the number of points; also x y z intensity r g b. .csv: a header with x, y, z and maybe nx, ny, nz,
 * red, green, blue (any case and order; comma, semicolon or tab). Each also with .gz. What else a file holds is left out. A normal that is zero or not finite
 * becomes that of the nearest point with one; where more than half are so, the cloud has none. Notes tell of both. path "-" is standard input and needs a
 * format. LCL_ERROR_BAD_INPUT names the line or point: not finite, a line with other columns than the first, a count that does not hold. */
LCL_API lcl_status lcl_cloud_read(const char* path, lcl_format format, lcl_cloud* cloud);
/** The same from bytes in memory; `name` stands in messages. */
LCL_API lcl_status lcl_cloud_read_memory(const void* bytes, size_t size, lcl_format format, const char* name, lcl_cloud* cloud);
LCL_API void lcl_cloud_retain(lcl_cloud cloud);
LCL_API void lcl_cloud_release(lcl_cloud cloud);
LCL_API size_t lcl_cloud_count(lcl_cloud cloud);
LCL_API int32_t lcl_cloud_has_normals(lcl_cloud cloud);
LCL_API int32_t lcl_cloud_has_colours(lcl_cloud cloud);
/** Each array count x 3, or NULL. Normals as they came; colours from 0 to 1. LCL_ERROR_INVALID_ARGUMENT for what the cloud does not have. */
LCL_API lcl_status lcl_cloud_get(lcl_cloud cloud, double* points, double* normals, double* colours);
/** Sentences on what was left out or is doubtful, from reading. */
LCL_API int32_t lcl_cloud_note_count(lcl_cloud cloud);
LCL_API const char* lcl_cloud_note(lcl_cloud cloud, int32_t index);

typedef LCL_ENUM(lcl_fit){
    LCL_FIT_INTERPOLATE = 0, /**< the limit surface passes through the vertices of the approximation */
    LCL_FIT_LEAST_SQUARES = 1 /**< its control points make the squared distances of all points, and a bending energy, smallest */} lcl_fit;

typedef LCL_ENUM(lcl_surface_phase){LCL_SURFACE_APPROXIMATE = 0, LCL_SURFACE_SIMPLIFY = 1, LCL_SURFACE_SOLVE = 2, LCL_SURFACE_MEASURE = 3,
                                    LCL_SURFACE_REFINE = 4} lcl_surface_phase;
/** round: of the fit, from 0; fraction: of the phase, negative where it is not known; max_distance: of the last round, model units, NaN before. Return 0 to
 * cancel (LCL_ERROR_CANCELLED), anything else to go on. */
typedef int32_t (*lcl_surface_callback)(void* user, lcl_surface_phase phase, int32_t round, double fraction, double max_distance);

typedef struct lcl_surface_options {
    uint32_t struct_size;
    lcl_fit fit;
    double tolerance;                        /**< of the distance of every point, relative to the diagonal; 0: 1e-3 */
    int32_t max_vertices;                    /**< at most so many, 4 or more; 0: as many as the tolerance takes */
    int32_t max_rounds;                      /**< solves of the whole fit; 0: 30 */
    int32_t fill_holes;                      /**< boundary loops of at most so many edges are filled, 3 to 1000; 0: none */
    double fair;                             /**< least squares: W, 0 or above; the _INIT holds 1e-3 */
    lcl_boundary boundary;                   /**< of the mesh that comes out */
    double crease_angle_degrees;             /**< > 0: edges of the approximation whose face normals differ by more are creases, and stay */
    const lcl_engine_option* engine_options; /**< engine_option_count of them, for the engine */
    size_t engine_option_count;
    lcl_precision precision;
    double solve_tolerance; /**< of each solve, relative to the diagonal; 0: 1e-6, and never more than a tenth of `tolerance` */
    int32_t max_iterations; /**< of each solve; 0: 200 */
    int32_t keep_going;     /**< 1: go on although A is singular or indefinite, or a solve does not converge; the status says so */
    lcl_surface_callback progress;
    void* progress_user;
} lcl_surface_options;
#define LCL_SURFACE_OPTIONS_INIT                                                                                                                            \
    {                                                                                                                                                       \
        (uint32_t)sizeof(lcl_surface_options), LCL_FIT_INTERPOLATE, 0.0, 0, 0, 0, 1e-3, LCL_BOUNDARY_DEFAULT, 0.0, NULL, 0, LCL_PRECISION_MIXED, 0.0, 0, 0, \
            NULL, NULL                                                                                                                                      \
    }

typedef struct lcl_surface_report {
    uint32_t struct_size;
    int64_t point_count;                                 /**< points that were measured */
    int64_t duplicate_count;                             /**< points at the place of an earlier one, dropped before all else */
    int64_t left_out_count;                              /**< outliers by the engine's options: not measured */
    int64_t unused_count;                                /**< measured points that are no vertex of the engine's approximation */
    int32_t approximation_vertices, approximation_faces; /**< what the engine gave, mended */
    int32_t components, boundary_loops;                  /**< of that, holes filled */
    int32_t filled_holes, dropped_faces, split_vertices; /**< mended: holes filled on request, faces beyond two at an edge, vertices where surfaces touched */
    int32_t simplified_vertices;                         /**< before the first solve */
    int32_t vertices, faces, creases;                    /**< of the control mesh */
    int32_t rounds;                                      /**< solves; least squares: corrections of the parameters */
    int32_t iterations;                                  /**< of all solves */
    int32_t converged;                                   /**< max <= tolerance x diagonal */
    double alpha;                                        /**< Catmull-Clark: the one in use, after alpha_auto at the first solve */
    double diagonal;                                     /**< of the vertices of the approximation, model units */
    double rms, p95, max;                                /**< distances of the points to the limit surface, model units */
    int64_t outside_count;                               /**< points farther away than the tolerance */
    double interpolation_error;                          /**< interpolation: largest |limit point - vertex|, model units; NaN for least squares */
    double seconds_approximate, seconds_simplify, seconds_solve, seconds_measure, seconds_refine, seconds_total;
    char message[512]; /**< one sentence where the tolerance is not reached; "" otherwise */
} lcl_surface_report;
#define LCL_SURFACE_REPORT_INIT                                                                                                                               \
    {                                                                                                                                                         \
        (uint32_t)sizeof(lcl_surface_report), 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, \
            0.0, ""                                                                                                                                           \
    }

/** Control mesh of a limit surface through a point cloud (Doo-Sabin paper): the engine makes a polyhedral approximation; it is mended (edges of three faces,
 * vertices where surfaces touch), oriented (closed parts outwards, open ones by the cloud's normals where it has any), its holes are filled on request, and it
 * is simplified by edge collapses (quadrics) within the tolerance; its vertices are interpolated; the distances of all points to the limit surface are
 * measured; where they exceed the tolerance points become vertices, and so on, until none does or max_vertices is reached. All parts of the cloud are kept.
 * scheme: NULL or LCL_SCHEME_DEFAULT: Doo-Sabin; subset, owned, lambda and lambda_per_vertex are refused. Colours of the cloud go to the nearest vertices.
 * mesh: control points, with the creases and corners that it is to be read with; its notes of kind LCL_NOTE_WARNING tell what was mended. report may be NULL.
 * LCL_ERROR_BAD_INPUT: fewer than four different points, all of them in a plane, an engine that finds no surface; LCL_ERROR_INVALID_ARGUMENT: options, also the
 * engine's. Results with report, and with mesh where the last solve came through (or keep_going is set), else *mesh stays as it was:
 * LCL_ERROR_NOT_CONVERGED where the tolerance is not reached and max_vertices is 0 (with it: LCL_OK, converged 0), or a solve ends above its tolerance;
 * LCL_ERROR_SINGULAR, LCL_ERROR_INDEFINITE. Beside what the engine takes, memory is some 600 bytes a point; least squares take 200 bytes a point and 5 to 10 kB
 * a vertex more. Costs the engine's time, a simplification of 20 to 100 microseconds a vertex of the approximation, and each round a solve and a search of
 * closest points, some 2 to 10 microseconds a point that is near a change. The inner wall of a hollow solid is turned outwards as well. The engine and progress
 * are called on this thread, progress between the steps of a phase: a search or a solve that is under way ends first. */
LCL_API lcl_status lcl_surface(lcl_context context, lcl_cloud cloud, const lcl_engine* engine, const lcl_scheme_options* scheme,
                               const lcl_surface_options* options, lcl_mesh* mesh, lcl_surface_report* report);

#ifdef __cplusplus
}
#endif

#endif
