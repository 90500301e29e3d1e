// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/progress.h"

#include <algorithm>
#include <cstdio>

namespace lcl::cli {

namespace {

std::string bar(double fraction) {
    constexpr int width = 24;
    const int filled = std::clamp(static_cast<int>(fraction * width), 0, width);
    return "[" + std::string(static_cast<std::size_t>(filled), '#') + std::string(static_cast<std::size_t>(width - filled), '.') + "] ";
}

}  // namespace

void Progress::begin(const std::string& what) {
    if (!enabled_) return;
    end();
    what_ = what;
    detail_.clear();
    fraction_ = -1.0;
    start_ = std::chrono::steady_clock::now();
    running_ = true;
    thread_ = std::thread([this] { run(); });
}

void Progress::update(double fraction, const std::string& detail) {
    if (!enabled_) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    fraction_ = fraction;
    detail_ = detail;
}

void Progress::end() {
    if (!thread_.joinable()) return;
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        running_ = false;
    }
    ended_.notify_one();
    thread_.join();
    clear();
}

void Progress::print(const std::string& lines) {
    const std::lock_guard<std::mutex> lock(mutex_);
    clear();
    std::fputs(lines.c_str(), stderr);
    std::fflush(stderr);
}

void Progress::run() {
    std::unique_lock<std::mutex> lock(mutex_);
    const auto over = [this] { return !running_; };
    if (ended_.wait_for(lock, std::chrono::seconds(1), over)) return;
    do draw();
    while (!ended_.wait_for(lock, std::chrono::milliseconds(200), over));
}

void Progress::draw() {
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    const std::string text = what_ + "  " + (fraction_ >= 0.0 ? bar(fraction_) : "") + detail_;
    std::fprintf(stderr, "\r\033[K%s  %.0f s", text.c_str(), seconds);
    std::fflush(stderr);
    drawn_ = true;
}

void Progress::clear() {
    if (!drawn_) return;
    std::fputs("\r\033[K", stderr);
    std::fflush(stderr);
    drawn_ = false;
}

}  // namespace lcl::cli
