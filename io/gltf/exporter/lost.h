// SPDX-License-Identifier: Apache-2.0
// Traces of the program that wrote a file: what that program leaves out, and its units. Facts about
// Blender: its exporter, github.com/KhronosGroup/glTF-Blender-IO, versions 3.4 to 4.2.
#pragma once

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace petzval::io {

/// Losses by the exporter, a line each: what probably was in the scene and is not in its file, the
/// sign of it, and what to do. None where the file is not Blender's. root: checked JSON; shown:
/// numbers of its nodes that the scene shows; has_sky: the scene names one.
[[nodiscard]] std::vector<std::string> lost_by_exporter(const nlohmann::json& root,
                                                        std::span<const int> shown, bool has_sky);

/// Sentence about the brightness of lamps in the exporter's default units; empty where the file is
/// not Blender's or has no lamps.
[[nodiscard]] std::string lamp_unit_doubt(const nlohmann::json& root);

}  // namespace petzval::io
