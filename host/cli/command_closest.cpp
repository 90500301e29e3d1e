// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/commands.h"
#include "host/cli/failure.h"
#include "host/cli/points.h"
#include "host/cli/surface_step.h"

namespace lcl::cli {

namespace {

/// Closest points of a piece.
struct Closest {
    std::vector<std::int32_t> faces = std::vector<std::int32_t>(rows_a_piece), corners = faces;
    std::vector<double> uv = std::vector<double>(2 * rows_a_piece), points = std::vector<double>(3 * rows_a_piece), normals = points;
    std::vector<double> distances = std::vector<double>(rows_a_piece);

    lcl_closest_points arrays() {
        lcl_closest_points closest = LCL_CLOSEST_POINTS_INIT;
        closest.faces = faces.data();
        closest.corners = corners.data();
        closest.uv = uv.data();
        closest.points = points.data();
        closest.normals = normals.data();
        closest.distances = distances.data();
        return closest;
    }

    void append(std::string& text, std::size_t row) const {
        append_number(text, points[3 * row]);
        append_cell(text, points[3 * row + 1]);
        append_cell(text, points[3 * row + 2]);
        text += "," + std::to_string(faces[row]) + "," + std::to_string(corners[row]);
        append_cell(text, uv[2 * row]);
        append_cell(text, uv[2 * row + 1]);
        append_cell(text, distances[row]);
        append_vector(text, &normals[3 * row]);
    }
};

std::vector<double> read_points_of_job(Job& job) {
    const Phase phase(job, &Seconds::read, "reading " + job.options.points_file);
    return read_points(job, job.options.points_file);
}

}  // namespace

void run_closest(Job& job) {
    DeviceOpening device(job);
    const Mesh mesh = read_sound_input(job);
    const std::vector<double> points = read_points_of_job(job);
    const std::size_t count = points.size() / 3;
    job.report.set_parameter("points", static_cast<std::int64_t>(count));
    const SurfaceOfInput input = open_surface(job, device, mesh.get());
    Closest found;
    const lcl_closest_points arrays = found.arrays();
    const auto compute = [&](std::size_t first, std::size_t size) {
        check(lcl_limit_surface_closest(input.surface.get(), size, &points[3 * first], 0, &arrays));
    };
    const auto append = [&](std::string& text, std::size_t, std::size_t row) { found.append(text, row); };
    write_in_pieces(job, input.context.get(), count, "x,y,z,face,corner,u,v,distance,nx,ny,nz", compute, append);
    job.terminal.say("wrote", shown_output(job.options) + ": " + counted(static_cast<long long>(count), "closest point", "closest points"));
}

}  // namespace lcl::cli
