# SPDX-License-Identifier: BSD-3-Clause
# Shared by examples/quickstart and tests/run: installs what is missing on Debian, runs steps quietly, shows the log of a step that failed.
# The caller sets `root` (the project) and `logs` (a folder for logs) first.

say() { printf '%s\n' "$*"; }
fail() { printf '%s\n' "$*" >&2; exit 1; }

missing=()

# need PACKAGE..: Debian packages that must be installed.
need() {
    command -v dpkg-query >/dev/null || return 0
    local package
    for package; do
        dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
    done
}

# need_tool COMMAND PACKAGE: the package, unless the command is there already, wherever it comes from.
need_tool() { command -v "$1" >/dev/null || need "$2"; }

# What building the library and the program takes.
need_for_build() {
    need_tool c++ g++
    need_tool cc gcc
    need_tool cmake cmake
    command -v make >/dev/null || need_tool ninja ninja-build
    need ocl-icd-opencl-dev opencl-headers libeigen3-dev libopenmesh-dev libclblast-dev libnanoflann-dev zlib1g-dev libcli11-dev nlohmann-json3-dev
}

# PoCL, an OpenCL device on every processor; at run time it calls the linker.
need_pocl() {
    need pocl-opencl-icd
    need_tool ld binutils
}

has_opencl_driver() { [ -n "${OCL_ICD_VENDORS:-}" ] || compgen -G '/etc/OpenCL/vendors/*.icd' >/dev/null; }

# Installs what the calls above found missing, with one look at the package lists. Asks for nothing.
install_missing() {
    [ ${#missing[@]} -gt 0 ] || return 0
    local admin=()
    if [ "$(id -u)" != 0 ]; then
        if command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
            admin=(sudo -n)
        else
            fail "Some packages are missing, and installing them takes root. Run this, then $0 again:
    sudo apt-get update && sudo apt-get install -y --no-install-recommends ${missing[*]}"
        fi
    fi
    command -v apt-get >/dev/null || fail "These Debian packages (or what your system calls them) are missing: ${missing[*]}"
    say "Installing with apt-get: ${missing[*]}"
    step "package lists" install "${admin[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq update
    step "packages" install "${admin[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -qq -y --no-install-recommends install "${missing[@]}"
    missing=()
}

# step TITLE LOG COMMAND..: runs the command with its output in logs/LOG.log; one line with the seconds, or the end of the log and exit 1.
step() {
    local title=$1 log=$logs/$2.log start=$SECONDS
    shift 2
    mkdir -p "$logs"
    printf '  %-44s' "$title"
    if "$@" >"$log" 2>&1 </dev/null; then
        say "$((SECONDS - start)) s"
    else
        say "failed after $((SECONDS - start)) s: $*"
        tail -n 40 "$log" >&2
        fail "The whole log: $log"
    fi
}

# configure PRESET [cmake argument]..: cmake --preset, with Ninja where it is installed and nothing else was chosen.
configure() {
    if [ ! -e "build/$1/CMakeCache.txt" ] && [ -z "${CMAKE_GENERATOR:-}" ] && command -v ninja >/dev/null; then
        local -x CMAKE_GENERATOR=Ninja
    fi
    cmake --preset "$@"
}

# is_configured PRESET: the last configuration went through (a failed one leaves a cache but no build files).
is_configured() { [ -e "build/$1/build.ninja" ] || [ -e "build/$1/Makefile" ]; }
