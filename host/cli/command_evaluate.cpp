// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cstdio>

#include "host/cli/commands.h"
#include "host/cli/failure.h"
#include "host/cli/surface_step.h"

namespace lcl::cli {

namespace {

/// Places of the file --at.
struct PlaceTable {
    Table table;  ///< face,corner,u,v
    std::vector<std::int32_t> faces, corners;
    std::vector<double> uv;
};

std::int32_t whole_number(const Table& table, std::size_t row, std::size_t column, const char* what) {
    const double value = table.values[row * table.columns + column];
    if (!(value >= -2147483648.0 && value <= 2147483647.0) || value != static_cast<double>(static_cast<std::int32_t>(value)))
        fail_at(table.path, table.lines[row], std::string("the ") + what + " is not a whole number");
    return static_cast<std::int32_t>(value);
}

PlaceTable read_places(Job& job) {
    const Phase phase(job, &Seconds::read, "reading " + job.options.places_file);
    PlaceTable places;
    places.table = read_table(job.options.places_file, "face,corner,u,v");
    for (std::size_t row = 0; row < places.table.rows(); ++row) {
        places.faces.push_back(whole_number(places.table, row, 0, "face"));
        places.corners.push_back(whole_number(places.table, row, 1, "corner"));
        const double* cells = &places.table.values[row * places.table.columns];
        places.uv.insert(places.uv.end(), {cells[2], cells[3]});
    }
    return places;
}

/// The library names a place by its index among those of the call, "place 17: ...": the file's line stands for it.
[[noreturn]] void fail_at_place(lcl_status status, const PlaceTable& places, std::size_t first) {
    Failure failure = failure_of(status);
    unsigned long index = 0;
    int length = 0;
    if (status == LCL_ERROR_BAD_INPUT && std::sscanf(failure.message.c_str(), "place %lu: %n", &index, &length) == 1 && length > 0) {
        const std::size_t row = first + index;
        if (row < places.table.rows())
            failure.message =
                places.table.path + ":" + std::to_string(places.table.lines[row]) + ": " + failure.message.substr(static_cast<std::size_t>(length));
    }
    throw failure;
}

/// What is computed for a piece of the places, by the columns of --derivatives.
struct Evaluation {
    std::vector<double> points, du, dv, normals, duu, duv, dvv, gauss, mean;

    explicit Evaluation(int derivatives) {
        const std::size_t count = rows_a_piece;
        points.resize(3 * count);
        if (derivatives < 1) return;
        for (auto* rows : {&du, &dv, &normals}) rows->resize(3 * count);
        if (derivatives < 2) return;
        for (auto* rows : {&duu, &duv, &dvv}) rows->resize(3 * count);
        gauss.resize(count);
        mean.resize(count);
    }

    lcl_surface_values arrays() {
        const auto data = [](std::vector<double>& values) { return values.empty() ? nullptr : values.data(); };
        lcl_surface_values values = LCL_SURFACE_VALUES_INIT;
        values.points = data(points);
        values.du = data(du);
        values.dv = data(dv);
        values.normals = data(normals);
        values.duu = data(duu);
        values.duv = data(duv);
        values.dvv = data(dvv);
        values.gauss = data(gauss);
        values.mean = data(mean);
        return values;
    }

    void append(std::string& text, std::size_t row) const {
        for (const auto* rows : {&points, &du, &dv, &normals, &duu, &duv, &dvv}) {
            if (!rows->empty()) append_vector(text, &(*rows)[3 * row]);
        }
        if (gauss.empty()) return;
        append_cell(text, gauss[row]);
        append_cell(text, mean[row]);
    }
};

std::string header_of(int derivatives) {
    std::string header = "face,corner,u,v,x,y,z";
    if (derivatives >= 1) header += ",xu,yu,zu,xv,yv,zv,nx,ny,nz";
    if (derivatives >= 2) header += ",xuu,yuu,zuu,xuv,yuv,zuv,xvv,yvv,zvv,gauss,mean";
    return header;
}

void write_values(Job& job, lcl_context context, lcl_limit_surface surface, const PlaceTable& places) {
    Evaluation found(job.options.derivatives);
    const lcl_surface_values arrays = found.arrays();
    const auto compute = [&](std::size_t first, std::size_t count) {
        const lcl_status status = lcl_limit_surface_evaluate(surface, count, &places.faces[first], &places.corners[first], &places.uv[2 * first], &arrays);
        if (status != LCL_OK) fail_at_place(status, places, first);
    };
    const auto append = [&](std::string& text, std::size_t first, std::size_t row) {
        text += std::to_string(places.faces[first + row]) + "," + std::to_string(places.corners[first + row]);
        append_cell(text, places.uv[2 * (first + row)]);
        append_cell(text, places.uv[2 * (first + row) + 1]);
        found.append(text, row);
    };
    write_in_pieces(job, context, places.faces.size(), header_of(job.options.derivatives), compute, append);
}

}  // namespace

void run_evaluate(Job& job) {
    DeviceOpening device(job);
    const Mesh mesh = read_sound_input(job);
    const PlaceTable places = read_places(job);
    job.report.set_parameter("derivatives", static_cast<std::int64_t>(job.options.derivatives));
    job.report.set_parameter("places", static_cast<std::int64_t>(places.faces.size()));
    const SurfaceOfInput input = open_surface(job, device, mesh.get());
    write_values(job, input.context.get(), input.surface.get(), places);
    job.terminal.say("wrote", shown_output(job.options) + ": " + counted(static_cast<long long>(places.faces.size()), "place", "places"));
}

}  // namespace lcl::cli
