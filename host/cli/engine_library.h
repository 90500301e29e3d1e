// SPDX-License-Identifier: BSD-3-Clause
// The engines of `surface`: shared libraries limitcl_engine_*.so, found and loaded at run time, so that neither the program nor the library of limitcl has
// anything to do with what they link.
#pragma once

#include <string>
#include <vector>

#include <limitcl/limitcl_engine.h>

namespace lcl::cli {

struct Engine {
    std::string name, description, licence;
    std::string options;  ///< a line for each, "KEY=DEFAULT  what it does, its range"
    std::string file;     ///< the library that it is in, which stays loaded until the program ends
    const lcl_engine* engine = nullptr;
};

/// The engines of all libraries in the folder of engines, the best first: that is the environment's LIMITCL_ENGINE_DIR where it is set, else `limitcl` beside
/// the library of limitcl. Of two with one name the first is meant. warnings: gets a sentence for each library that cannot be used.
std::vector<Engine> installed_engines(std::vector<std::string>& warnings);

/// The engine of that name; "": the first installed. Libraries behind it are not loaded. Throws Failure where it is not there, with exit code 2 where a name
/// was given, else 1: the sentence tells what is there, what is missing, and how to get it.
Engine choose_engine(const std::string& name, std::vector<std::string>& warnings);

/// Throws Failure, exit code 2, where the engine has no option of that name.
void require_option(const Engine& engine, const std::string& key);

}  // namespace lcl::cli
