// SPDX-License-Identifier: BSD-3-Clause
#include "host/points/approximate.h"

#include <exception>
#include <utility>

namespace lcl {
namespace {

constexpr std::int32_t most_triangles = 715827882;  // whose corners an Index can number

std::string text_or_none(const char* text) { return text != nullptr ? text : ""; }

/// Where the engine's callbacks put things. They are called from foreign code, so what they throw waits until the engine has returned.
struct Receiver {
    const PointCloud& cloud;
    const std::function<bool(double)>& progress;
    Approximation out;
    std::string failure, broken;
    bool was_given = false;
    std::exception_ptr thrown;

    template <class Body>
    void guard(const Body& body) {
        try {
            if (!thrown) body();
        } catch (...) {
            thrown = std::current_exception();
        }
    }

    void take(std::int32_t vertices, const double* points, std::int32_t triangles, const std::int32_t* corners) {
        if (was_given) broken = "it gave triangles twice";
        else if (triangles > most_triangles) broken = "it gave " + std::to_string(triangles) + " triangles, the most is " + std::to_string(most_triangles);
        else if (vertices < 0 || triangles < 0 || (triangles > 0 && corners == nullptr)) broken = "it gave a negative number, or no array";
        else if (points == nullptr && static_cast<std::size_t>(vertices) != cloud.count()) broken = "it gave triangles on another number of points than it got";
        if (!broken.empty()) return;
        was_given = true;
        out.keeps_points = points == nullptr;
        if (points == nullptr) out.raw.points = cloud.points;
        else out.raw.points.assign(points, points + 3 * static_cast<std::size_t>(vertices));
        out.raw.triangles.assign(corners, corners + 3 * static_cast<std::size_t>(triangles));
    }

    void leave_out(std::int32_t count, const std::int32_t* indices) {
        if (count < 0 || (count > 0 && indices == nullptr)) broken = "it left out a negative number of points, or gave no array";
        for (std::int32_t i = 0; i < count && broken.empty(); ++i) {
            if (indices[i] < 0 || static_cast<std::size_t>(indices[i]) >= cloud.count()) {
                broken = "it left out point " + std::to_string(indices[i]) + ", there are " + std::to_string(cloud.count());
                return;
            }
            out.is_out[indices[i]] = 1;
        }
    }
};

Receiver& of(void* self) { return *static_cast<Receiver*>(self); }

lcl_engine_sink sink_of(Receiver& receiver) {
    lcl_engine_sink sink{};
    sink.struct_size = sizeof sink;
    sink.self = &receiver;
    sink.progress = [](void* self, double fraction) -> std::int32_t {
        bool goes_on = true;
        of(self).guard([&] { goes_on = !of(self).progress || of(self).progress(fraction); });
        return goes_on && !of(self).thrown;
    };
    sink.give = [](void* self, std::int32_t vertices, const double* points, std::int32_t triangles, const std::int32_t* corners) {
        of(self).guard([&] { of(self).take(vertices, points, triangles, corners); });
    };
    sink.leave_out = [](void* self, std::int32_t count, const std::int32_t* indices) { of(self).guard([&] { of(self).leave_out(count, indices); }); };
    sink.warn = [](void* self, const char* sentence) { of(self).guard([&] { of(self).out.warnings.push_back(text_or_none(sentence)); }); };
    sink.fail = [](void* self, const char* sentence) { of(self).guard([&] { of(self).failure = text_or_none(sentence); }); };
    return sink;
}

void check_result(const std::string& name, std::int32_t result, const Receiver& receiver) {
    const std::string failure = "engine " + name + ": " + (receiver.failure.empty() ? "it failed without a sentence" : receiver.failure);
    if (receiver.thrown) std::rethrow_exception(receiver.thrown);
    switch (result) {
        case LCL_ENGINE_OK: break;
        case LCL_ENGINE_OPTION: throw InvalidArgument(failure);
        case LCL_ENGINE_CANCELLED: throw Cancelled("the approximation of the points was cancelled");
        case LCL_ENGINE_MEMORY: throw OutOfMemory(failure);
        default: throw BadInput(failure);
    }
    if (!receiver.broken.empty()) throw Error("engine " + name + " is defective: " + receiver.broken);
    if (receiver.out.raw.triangles.empty())
        throw BadInput("engine " + name + " found no surface in these " + std::to_string(receiver.cloud.count()) +
                       " points: they may be too few or too far apart for it");
}

}  // namespace

Approximation approximate(const lcl_engine& engine, const PointCloud& cloud, const EngineOptions& options, const std::function<bool(double)>& progress) {
    if (engine.struct_size < sizeof engine) throw InvalidArgument("engine.struct_size is not set, or of an older version: it is the size of lcl_engine");
    if (engine.run == nullptr || engine.name == nullptr) throw InvalidArgument("the engine has no name or no function to run");
    Receiver receiver{cloud, progress, {}, {}, {}, false, nullptr};
    receiver.out.is_out.assign(cloud.count(), 0);
    const lcl_engine_sink sink = sink_of(receiver);
    lcl_engine_points points{};
    points.struct_size = sizeof points;
    points.count = static_cast<std::int32_t>(cloud.count());
    points.points = cloud.points.data();
    points.normals = cloud.normals.empty() ? nullptr : cloud.normals.data();
    std::vector<lcl_engine_option> pairs;
    for (const auto& [key, value] : options) pairs.push_back({key.c_str(), value.c_str()});
    check_result(engine.name, engine.run(engine.user, &points, pairs.data(), pairs.size(), &sink), receiver);
    return std::move(receiver.out);
}

}  // namespace lcl
