// SPDX-License-Identifier: BSD-3-Clause
// One line on a terminal for anything that takes more than a second.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace lcl::cli {

/// While a phase runs, a thread of its own draws "what  [####....]  detail  seconds" on standard error, from one second on. Does nothing where not enabled.
class Progress {
public:
    explicit Progress(bool enabled) : enabled_(enabled) {}
    ~Progress() { end(); }
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void begin(const std::string& what);
    /// fraction: 0 to 1, or negative where it is not known.
    void update(double fraction, const std::string& detail);
    /// Ends the phase and clears the line.
    void end();
    /// Writes whole lines to standard error, above the line of the progress.
    void print(const std::string& lines);

private:
    void run();
    void draw();
    void clear();

    const bool enabled_;
    std::mutex mutex_;
    std::condition_variable ended_;
    std::thread thread_;
    std::chrono::steady_clock::time_point start_;
    std::string what_, detail_;
    double fraction_ = -1.0;
    bool running_ = false, drawn_ = false;
};

}  // namespace lcl::cli
