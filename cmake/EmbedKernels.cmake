# SPDX-License-Identifier: BSD-3-Clause
# limitcl_embed_kernels(<variable> <file>...): puts the text of kernel files, and of the headers that they include by `#include "x.cl.h"`, into C++ sources
# that are made at build time, so that an edit rebuilds them. <variable> gets the list of generated sources, which define lcl::embedded_kernels()
# (host/device/embedded_kernels.h). The same file, run by `cmake -P`, is the generator: it writes arrays of bytes, because string literals have
# a length limit and quoting rules.
if(CMAKE_SCRIPT_MODE_FILE)
    file(READ "${INPUT}" bytes HEX)
    string(REGEX REPLACE "(................................)" "\\1\n    " bytes "${bytes}")  # 16 bytes a line
    string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
    file(WRITE "${OUTPUT}" "// Made from kernels/${NAME}.\nnamespace lcl {\n"
        "extern const unsigned char ${SYMBOL}[];\nextern const unsigned long ${SYMBOL}_size;\n"
        "const unsigned char ${SYMBOL}[] = {\n    ${bytes}0};\nconst unsigned long ${SYMBOL}_size = sizeof ${SYMBOL} - 1;\n}  // namespace lcl\n")
    return()
endif()

# Adds the files that those in the list <variable> include, directly or through others; an edit of any of them runs CMake again, for its includes may change.
function(limitcl_add_kernel_headers variable)
    set(pending ${${variable}})
    while(pending)
        list(POP_FRONT pending file)
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
        get_filename_component(folder "${file}" DIRECTORY)
        file(STRINGS "${file}" lines REGEX "^#include \"")
        foreach(line IN LISTS lines)
            string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" header "${line}")
            if(NOT "${folder}/${header}" IN_LIST ${variable})
                list(APPEND ${variable} "${folder}/${header}")
                list(APPEND pending "${folder}/${header}")
            endif()
        endforeach()
    endwhile()
    set(${variable} "${${variable}}" PARENT_SCOPE)
endfunction()

set(LIMITCL_EMBED_SCRIPT "${CMAKE_CURRENT_LIST_FILE}")

function(limitcl_embed_kernels variable)
    set(folder "${CMAKE_CURRENT_BINARY_DIR}/kernels")
    set(declarations "")
    set(entries "")
    set(sources "${folder}/embedded_kernels.cpp")
    set(files "")
    foreach(file IN LISTS ARGN)
        get_filename_component(file "${file}" ABSOLUTE)
        list(APPEND files "${file}")
    endforeach()
    limitcl_add_kernel_headers(files)
    foreach(input IN LISTS files)
        get_filename_component(name "${input}" NAME)
        string(MAKE_C_IDENTIFIER "embedded_${name}" symbol)
        set(output "${folder}/${name}.cpp")
        add_custom_command(OUTPUT "${output}"
            COMMAND "${CMAKE_COMMAND}" "-DINPUT=${input}" "-DOUTPUT=${output}" "-DNAME=${name}" "-DSYMBOL=${symbol}" -P "${LIMITCL_EMBED_SCRIPT}"
            DEPENDS "${input}" "${LIMITCL_EMBED_SCRIPT}" COMMENT "Embedding kernels/${name}" VERBATIM)
        string(APPEND declarations "extern const unsigned char ${symbol}[];\nextern const unsigned long ${symbol}_size;\n")
        string(APPEND entries "        {\"${name}\", {reinterpret_cast<const char*>(${symbol}), ${symbol}_size}},\n")
        list(APPEND sources "${output}")
    endforeach()
    list(LENGTH files count)
    file(CONFIGURE OUTPUT "${folder}/embedded_kernels.cpp" @ONLY CONTENT [[
#include "host/device/embedded_kernels.h"

namespace lcl {

@declarations@
EmbeddedKernels embedded_kernels() {
    static const EmbeddedKernel files[] = {
@entries@    };
    return {files, @count@};
}

}  // namespace lcl
]])
    set(${variable} "${sources}" PARENT_SCOPE)
endfunction()
