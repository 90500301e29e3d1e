// SPDX-License-Identifier: BSD-3-Clause
#include "host/cli/points.h"

#include "host/cli/failure.h"
#include "host/cli/handles.h"

namespace lcl::cli {

bool is_points_name(const std::string& path) {
    lcl_format format = LCL_FORMAT_BY_ENDING;
    return lcl_format_of_path(path.c_str(), &format) == LCL_OK && format != LCL_FORMAT_STL && format != LCL_FORMAT_OM;
}

std::vector<double> read_points(Job& job, const std::string& path) {
    lcl_cloud handle = nullptr;
    check_of_file(path, lcl_cloud_read(path.c_str(), LCL_FORMAT_BY_ENDING, &handle));
    const Cloud cloud(handle);
    for (int index = 0; index < lcl_cloud_note_count(cloud.get()); ++index) {
        const std::string note = lcl_cloud_note(cloud.get(), index);
        warn(job, note.find(path) == std::string::npos ? path + ": " + note : note);
    }
    std::vector<double> points(3 * lcl_cloud_count(cloud.get()));
    check(lcl_cloud_get(cloud.get(), points.data(), nullptr, nullptr));
    return points;
}

}  // namespace lcl::cli
