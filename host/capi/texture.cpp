// SPDX-License-Identifier: BSD-3-Clause
#include "host/filter/texture.h"

#include <cmath>

#include "host/capi/arguments.h"
#include "host/filter/colour_curve.h"

using namespace lcl;

namespace {

constexpr int default_octaves = 4;
constexpr double default_frequency = 8;
constexpr double most_cells = 4294967296.0;  // across the diagonal: places in them keep 21 of a double's 53 bits

/// Veins in white marble.
std::vector<Colour> marble() { return {{0.16, 0.17, 0.21}, {0.45, 0.46, 0.50}, {0.74, 0.74, 0.75}, {0.91, 0.90, 0.88}, {0.98, 0.97, 0.95}}; }

std::vector<Colour> colours_of(const lcl_texture_options& given) {
    if (given.colours == nullptr && given.colour_count == 0) return marble();
    required(given.colours, "options.colours");
    std::vector<Colour> colours(given.colour_count);
    for (std::size_t j = 0; j < colours.size(); ++j)
        for (std::size_t c = 0; c < 3; ++c) {
            colours[j][c] = given.colours[3 * j + c];
            if (!(colours[j][c] >= 0 && colours[j][c] <= 1))
                throw InvalidArgument("options.colours: component " + std::to_string(c) + " of colour " + std::to_string(j) + " is " +
                                      std::to_string(colours[j][c]) + ", it goes from 0 to 1");
        }
    return colours;
}

SolveOptions solve_options(const lcl_texture_options& given) {
    if (!(given.tolerance >= 0)) throw InvalidArgument("options.tolerance is " + std::to_string(given.tolerance) + ", it is above 0");
    if (given.max_iterations < 0) throw InvalidArgument("options.max_iterations is " + std::to_string(given.max_iterations) + ", it is at least 1");
    SolveOptions options;
    options.precision = inner_precision(given.precision);
    if (given.tolerance > 0) options.tolerance = given.tolerance;
    if (given.max_iterations > 0) options.max_iterations = given.max_iterations;
    options.keep_going = given.keep_going != 0;
    if (given.progress != nullptr)
        options.progress = [given](int iteration, double residual, double target) {
            return given.progress(given.progress_user, iteration, residual, target) != 0;
        };
    return options;
}

void check_frequency(const TextureOptions& options) {
    const double cells = std::ldexp(options.frequency, options.octaves - 1);
    if (cells <= most_cells) return;
    throw InvalidArgument("octave " + std::to_string(options.octaves - 1) + " would have " + std::to_string(cells) +
                          " noise cells across the diagonal, finer than coordinates tell apart (at most " +
                          std::to_string(static_cast<std::int64_t>(most_cells)) + "): lower the frequency or the number of octaves");
}

TextureOptions inner_options(const lcl_texture_options& given) {
    TextureOptions options;
    options.octaves = given.octaves == 0 ? default_octaves : given.octaves;
    if (options.octaves < 1 || options.octaves > most_octaves)
        throw InvalidArgument("options.octaves is " + std::to_string(given.octaves) + ", it goes from 1 to " + std::to_string(most_octaves));
    options.levels = given.levels == 0 ? options.octaves - 1 : given.levels;
    if (options.levels < options.octaves - 1)
        throw InvalidArgument("options.levels is " + std::to_string(given.levels) + ", and " + std::to_string(options.octaves) + " octaves need at least " +
                              std::to_string(options.octaves - 1) + ", one less than there are octaves");
    options.frequency = given.frequency == 0 ? default_frequency : given.frequency;
    if (!(options.frequency > 0) || !std::isfinite(options.frequency))
        throw InvalidArgument("options.frequency is " + std::to_string(given.frequency) + ", it is a number above 0");
    check_frequency(options);
    options.seed = given.seed;
    options.solve = solve_options(given);
    return options;
}

/// What a texture gives by itself.
bool is_replaced(const VertexProperty& property) {
    return property.name == "red" || property.name == "green" || property.name == "blue" || property.name == "noise";
}

/// The properties that are refined, as channels; `kept` receives them without values.
FurtherChannels further_channels(const lcl_mesh_s& mesh, std::vector<VertexProperty>& kept) {
    FurtherChannels further;
    std::vector<const std::vector<double>*> columns;
    for (const VertexProperty& property : mesh.file.properties) {
        if (is_replaced(property)) continue;
        kept.push_back({property.name, property.kind, property.type, {}});
        columns.push_back(&property.values);
    }
    further.count = static_cast<int>(columns.size());
    for (std::size_t v = 0; !columns.empty() && v < columns[0]->size(); ++v)
        for (const std::vector<double>* column : columns) further.values.push_back((*column)[v]);
    return further;
}

/// The properties of the refined mesh: those that were kept, the noise, and colours in 8 bits, which is what PLY files hold.
std::vector<VertexProperty> textured_properties(const Texture& texture, std::vector<VertexProperty> kept, const ColourCurve& curve) {
    const std::size_t vertices = texture.noise.size();
    for (std::size_t c = 0; c < kept.size(); ++c) {
        kept[c].values.resize(vertices);
        for (std::size_t v = 0; v < vertices; ++v) kept[c].values[v] = texture.further.values[v * kept.size() + c];
    }
    kept.push_back({"noise", VertexProperty::Kind::scalar, "double", texture.noise});
    VertexProperty colours[3];
    for (std::size_t c = 0; c < 3; ++c) colours[c] = {c == 0 ? "red" : c == 1 ? "green" : "blue", VertexProperty::Kind::colour, "uchar", {}};
    for (const double t : texture.noise) {
        const Colour colour = curve.at(t);
        for (std::size_t c = 0; c < 3; ++c) colours[c].values.push_back(255 * colour[c]);
    }
    for (VertexProperty& property : colours) kept.push_back(std::move(property));
    round_integers(kept);
    return kept;
}

}  // namespace

extern "C" {

lcl_status lcl_texture(lcl_context context, lcl_mesh mesh, const lcl_scheme_options* scheme, const lcl_texture_options* options, lcl_mesh* textured,
                       lcl_solve_report* report) {
    return guarded([&] {
        required(textured, "textured");
        required(context, "context");
        required(mesh, "mesh");
        const lcl_scheme_options rules = options_or(scheme, LCL_SCHEME_OPTIONS_INIT, "scheme");
        const lcl_texture_options given = options_or(options, LCL_TEXTURE_OPTIONS_INIT, "options");
        options_or(report, LCL_SOLVE_REPORT_INIT, "report");  // refuses one without a size before any work
        const TextureOptions inner = inner_options(given);
        const ColourCurve curve(colours_of(given));
        if (rules.owned != nullptr || rules.owned_count > 0)
            throw InvalidArgument("scheme.owned is set, and a texture needs the rows of all vertices: leave it out");
        const std::unique_ptr<LimitSystem> system = make_system(*context, *mesh, rules);
        std::vector<VertexProperty> properties;
        FurtherChannels further = further_channels(*mesh, properties);
        Texture texture = make_texture(*system, mesh->file.mesh, mesh->named_features(), std::move(further), inner);
        if (texture.is_given) {
            auto out = make_refined_mesh(*mesh, std::move(texture.refined), inner.levels);
            out->file.properties = textured_properties(texture, std::move(properties), curve);
            *textured = out.release();
        }
        return conclude(texture.report, LCL_SOLVE_OPTIONS_INIT, report);
    });
}

}  // extern "C"
