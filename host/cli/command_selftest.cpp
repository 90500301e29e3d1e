// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/commands.h"
#include "host/cli/failure.h"

namespace lcl::cli {

namespace {

void record_check(void* user, const char* kernel, const char* what, double difference, double tolerance, std::int32_t passed) {
    static_cast<Report*>(user)->kernels->push_back({kernel, what, difference, tolerance, passed != 0});
}

std::string check_table(const Job& job) {
    std::vector<std::vector<std::string>> rows = {{"kernel", "what", "difference", "allowed", "result"}};
    for (const KernelCheck& check : *job.report.kernels) {
        const std::string result = check.passed ? job.terminal.coloured("ok", Colour::green) : job.terminal.coloured("FAILED", Colour::red);
        rows.push_back({check.kernel, check.what, short_number(check.difference), short_number(check.tolerance), result});
    }
    return table_text(rows);
}

}  // namespace

void run_selftest(Job& job) {
    const Context context = open_device(job);
    job.report.kernels.emplace();
    lcl_status status = LCL_OK;
    {
        const Phase phase(job, &Seconds::solve, "testing kernels", context.get());
        status = lcl_context_selftest(context.get(), record_check, &job.report);
    }
    if (job.options.report != "-") job.terminal.result(check_table(job));
    check(status);
    job.terminal.say("selftest", counted(static_cast<long long>(job.report.kernels->size()), "check agrees", "checks agree") + " with the host operator");
}

}  // namespace lcl::cli
