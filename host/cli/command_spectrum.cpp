// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "host/cli/bar_chart.h"
#include "host/cli/commands.h"
#include "host/cli/csv.h"
#include "host/cli/filter_step.h"
#include "host/cli/interrupt.h"

namespace lcl::cli {

namespace {

std::vector<double> energies_of(const SpectrumSummary& spectrum) {
    std::vector<double> energies;
    for (std::size_t first = 0; first < spectrum.energies.size(); first += spectrum.channels.size())
        energies.push_back(position_energy(&spectrum.energies[first]));
    return energies;
}

std::string spectrum_csv(const SpectrumSummary& spectrum) {
    const std::size_t width = spectrum.channels.size();
    std::string text = "term,energy," + join(spectrum.channels, ",") + "\n";
    for (std::size_t term = 0; term * width < spectrum.energies.size(); ++term) {
        const double* energies = &spectrum.energies[term * width];
        text += std::to_string(term);
        append_cell(text, position_energy(energies));
        for (std::size_t channel = 0; channel < width; ++channel) append_cell(text, energies[channel]);
        text += "\n";
    }
    return text;
}

std::string spectrum_svg(const Job& job) {
    BarChart chart;
    const std::string name = shown_input(job.options);
    chart.title = "Mesh expansion of " + name.substr(name.rfind('/') + 1) + " (" + job.report.scheme + ")";
    chart.x_label = "term i of (E - A)^i A M";
    chart.y_label = "energy of x, y and z, squares of model units";
    chart.values = energies_of(*job.report.spectrum);
    return to_svg(chart);
}

void write_spectrum(Job& job) {
    const std::string& path = job.options.output;
    const bool is_chart = has_ending(path, ".svg");
    if (path.empty() || path == "-") {
        if (job.options.report != "-") job.terminal.result(spectrum_csv(*job.report.spectrum));  // else the report has it
        return;
    }
    const Phase phase(job, &Seconds::write, "writing " + path);
    OutputFile file(path);
    file.write(is_chart ? spectrum_svg(job) : spectrum_csv(*job.report.spectrum));
    file.finish();
    job.terminal.say("wrote", path + ": " + counted(job.options.terms, "term", "terms"));
}

}  // namespace

void run_spectrum(Job& job) {
    DeviceOpening device(job);
    Mesh mesh = read_sound_input(job);
    const std::int32_t terms = job.options.terms;
    job.report.set_parameter("terms", static_cast<std::int64_t>(terms));
    const Filter filter = open_filter(job, device, std::move(mesh));
    SpectrumSummary spectrum{{"x", "y", "z"}, {}};
    spectrum.channels.insert(spectrum.channels.end(), filter.channels.begin(), filter.channels.end());
    spectrum.energies.resize(static_cast<std::size_t>(terms) * spectrum.channels.size());
    run_passes(job, filter, "taking energies",
               [&] { return lcl_spectrum(filter.A.get(), filter.values.data(), 0, filter.width(), job.options.precision, terms, spectrum.energies.data()); });
    check_interrupt();
    job.report.spectrum = std::move(spectrum);
    write_spectrum(job);
}

}  // namespace lcl::cli
