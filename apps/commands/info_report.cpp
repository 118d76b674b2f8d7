// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/info_report.h"

#include <fmt/format.h>

#include "apps/cli/console.h"
#include "io/gltf/info.h"

namespace petzval::apps {
namespace {

void print_list(const char* title, const std::vector<std::string>& lines) {
    if (lines.empty()) return;
    fmt::print("{}\n", title);
    for (const std::string& line : lines) print_line("  " + line);
}

std::string bounds_line(const Box3f& b) {
    const V3f size = b.max - b.min;
    return fmt::format(
        "bounds: {:.4g} x {:.4g} x {:.4g} m, from {:.4g},{:.4g},{:.4g} to {:.4g},{:.4g},{:.4g}",
        size.x, size.y, size.z, b.min.x, b.min.y, b.min.z, b.max.x, b.max.y, b.max.z);
}

std::string focus_line(const std::string& camera, const FoundFocus& found) {
    return fmt::format("--focus auto{}: {}", camera,
                       found.m > 0 ? fmt::format("{:.4g} m", found.m) : found.why_none);
}

std::string memory_line(const InfoReport& report) {
    uint64_t pictures = 0;
    for (const io::GltfSummary::Picture& one : report.file.holds.pictures) pictures += one.bytes;
    const auto mib = [](uint64_t bytes) { return static_cast<double>(bytes) * 0x1p-20; };
    const uint64_t meshes = report.file.holds.mesh_bytes, bvh = report.bvh_bytes;
    return fmt::format("memory: {:.1f} MiB: meshes {:.1f}, images {:.1f}, BVH {:.1f}",
                       mib(meshes + pictures + bvh), mib(meshes), mib(pictures), mib(bvh));
}

}  // namespace

void print_info(const InfoReport& report) {
    const io::GltfFile& file = report.file;
    std::vector<std::string> holds = file.contents;
    holds.push_back(memory_line(report));
    if (report.bounds) holds.push_back(bounds_line(*report.bounds));
    for (size_t i = 0; i < report.focus.size(); ++i)
        if (file.cameras.empty() || !file.cameras[i].orthographic)
            holds.push_back(focus_line(file.cameras.empty() ? "" : fmt::format(", camera {}", i),
                                       report.focus[i]));
    print_list("holds", holds);
    print_list("extensions", io::table_of(file.holds.extensions));
    print_list("honoured", file.honoured);
    print_list("ignored", file.ignored);
    print_list("probably lost by the exporter", file.lost);
    print_list("warnings", file.warnings);
}

}  // namespace petzval::apps
