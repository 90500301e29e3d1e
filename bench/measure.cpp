// SPDX-License-Identifier: BSD-3-Clause
#include "measure.h"

#include <cstdio>
#include <stdexcept>
#include <thread>

namespace bench {

void Laps::print() const {
    for (const auto& [name, seconds] : laps_) {
        std::printf("times %s", name.c_str());
        for (const double s : seconds) std::printf(" %.9g", s);
        std::printf("\n");
    }
    std::fflush(stdout);
}

void rest() { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }

void print_value(const std::string& name, double value) { std::printf("value %s %.9g\n", name.c_str(), value); }
void print_text(const std::string& name, const std::string& text) { std::printf("text %s %s\n", name.c_str(), text.c_str()); }

namespace {

Arguments parse(int argc, char** argv) {
    Arguments arguments;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word.rfind("--", 0) != 0) {
            arguments.part = word;
            continue;
        }
        if (i + 1 == argc) throw std::runtime_error(word + " needs a value");
        const std::string value = argv[++i];
        if (word == "--level") arguments.level = std::stoi(value);
        else if (word == "--runs") arguments.runs = std::stoi(value);
        else if (word == "--device") arguments.device = value;
        else if (word == "--file") arguments.file = value;
        else throw std::runtime_error(word + " is not an option");
    }
    return arguments;
}

}  // namespace

int run_program(int argc, char** argv, void (*part)(const Arguments&)) {
    try {
        part(parse(argc, argv));
        return 0;
    } catch (const std::exception& error) {
        std::fflush(stdout);
        std::fprintf(stderr, "%s: %s\n", argv[0], error.what());
        return 1;
    }
}

}  // namespace bench
