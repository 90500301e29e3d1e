// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <vector>

#include "host/device/embedded_kernels.h"
#include "host/error.h"

namespace lcl {

namespace {

constexpr std::string_view include_prefix = "#include \"";

const EmbeddedKernel& find_file(std::string_view name) {
    const EmbeddedKernels all = embedded_kernels();
    const auto found = std::find_if(all.begin(), all.end(), [&](const EmbeddedKernel& file) { return file.name == name; });
    if (found != all.end()) return *found;
    std::string list;
    for (const EmbeddedKernel& file : all) list += (list.empty() ? "" : ", ") + std::string(file.name);
    throw InvalidArgument("kernels/" + std::string(name) + " is not part of this library, which has " + list +
                          ": add it to the list of kernels in CMakeLists.txt");
}

std::string line_directive(std::size_t line, std::string_view name) { return "#line " + std::to_string(line) + " \"kernels/" + std::string(name) + "\"\n"; }

/// The name in `#include "name"`, empty for any other line.
std::string_view included_name(std::string_view line) {
    if (line.substr(0, include_prefix.size()) != include_prefix) return {};
    const std::string_view rest = line.substr(include_prefix.size());
    return rest.substr(0, rest.find('"'));
}

void append_file(std::string_view name, std::vector<std::string_view>& done, std::string& source) {
    if (std::find(done.begin(), done.end(), name) != done.end()) return;
    done.push_back(name);
    std::string_view text = find_file(name).text;
    source += line_directive(1, name);
    for (std::size_t line = 1; !text.empty(); ++line) {
        const std::size_t length = std::min(text.find('\n'), text.size());
        const std::string_view content = text.substr(0, length);
        text.remove_prefix(std::min(length + 1, text.size()));
        if (const std::string_view header = included_name(content); !header.empty()) {
            append_file(header, done, source);
            source += line_directive(line + 1, name);
        } else {
            source.append(content) += '\n';
        }
    }
}

}  // namespace

std::string kernel_source(const std::string& file) {
    std::string source;
    std::vector<std::string_view> done;
    append_file(file + ".cl", done, source);
    return source;
}

}  // namespace lcl
