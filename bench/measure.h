// SPDX-License-Identifier: BSD-3-Clause
// Timings of rounds in which all contestants take turns, and the lines that bench/run reads: "times NAME seconds..", "value NAME number", "text NAME words".
#ifndef LIMITCL_BENCH_MEASURE_H
#define LIMITCL_BENCH_MEASURE_H

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace bench {

using Clock = std::chrono::steady_clock;
inline double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class Laps {
public:
    void add(const std::string& name, double seconds) { laps_[name].push_back(seconds); }
    /// One call.
    template <class Body>
    void time(const std::string& name, const Body& body) {
        const Clock::time_point start = Clock::now();
        body();
        add(name, seconds_since(start));
    }
    /// The mean of as many calls as take 50 ms together: what takes less would be timed with caches and cores as the contestant before left them.
    template <class Body>
    void time_warm(const std::string& name, const Body& body) {
        const Clock::time_point start = Clock::now();
        int calls = 0;
        for (; calls == 0 || seconds_since(start) < 0.05; ++calls) body();
        add(name, seconds_since(start) / calls);
    }
    void print() const;

private:
    std::map<std::string, std::vector<double>> laps_;
};

/// Runs round(laps) once to warm up and then `runs` times, and prints those laps.
template <class Round>
void run_rounds(int runs, const Round& round) {
    Laps warm_up, laps;
    round(warm_up);
    for (int i = 0; i < runs; ++i) round(laps);
    laps.print();
}

/// Between contestants: OpenMP's threads spin for some milliseconds after their work, on cores that the next one needs.
void rest();

void print_value(const std::string& name, double value);
void print_text(const std::string& name, const std::string& text);

/// What the programs of the benchmark are told: PROGRAM PART [--level L] [--runs N] [--device SPEC] [--file PATH].
struct Arguments {
    std::string part, device, file;
    int level = 7, runs = 7;
};

/// Parses, calls part(arguments), and turns exceptions into one line and exit code 1.
int run_program(int argc, char** argv, void (*part)(const Arguments&));

}  // namespace bench

#endif
