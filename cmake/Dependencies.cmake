# SPDX-License-Identifier: BSD-3-Clause
# limitcl_require(<package> <debian package> [find_package arguments]): find_package, or one sentence that names the Debian package to install.
macro(limitcl_require package debian)
    find_package(${package} ${ARGN} QUIET)
    if(NOT ${package}_FOUND)
        message(FATAL_ERROR "limitcl needs ${package} ${ARGN}, which was not found. On Debian 12: apt-get install ${debian}")
    endif()
endmacro()

limitcl_require(OpenCL ocl-icd-opencl-dev)
limitcl_require(OpenCLHeaders opencl-headers CONFIG)
limitcl_require(Eigen3 libeigen3-dev 3.4 CONFIG)
limitcl_require(OpenMesh libopenmesh-dev CONFIG)
limitcl_require(ZLIB zlib1g-dev)
limitcl_require(Threads libc6-dev)
# Headers alone, without CMake files in Debian.
find_path(NANOFLANN_INCLUDE_DIR nanoflann.hpp)
if(NOT NANOFLANN_INCLUDE_DIR)
    message(FATAL_ERROR "limitcl needs nanoflann.hpp, which was not found. On Debian 12: apt-get install libnanoflann-dev")
endif()
# For the projections of large surfaces; without it a kernel of ours makes them all.
find_package(CLBlast CONFIG QUIET)
if(LIMITCL_BUILD_PROGRAM)
    limitcl_require(CLI11 libcli11-dev 2.1 CONFIG)
    limitcl_require(nlohmann_json nlohmann-json3-dev 3.9 CONFIG)
endif()
if(LIMITCL_BUILD_TESTS)
    limitcl_require(Catch2 catch2 2.13 CONFIG)  # 2.x: the test sources include <catch2/catch.hpp>
    limitcl_require(tinyobjloader libtinyobjloader-dev CONFIG)
endif()
