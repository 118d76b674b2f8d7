// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/validate/foreign.h"

#include <fmt/format.h>

#include <array>
#include <string_view>

#include "io/base/ascii.h"

namespace petzval::io {
namespace {

/// Format by the ending of its files. opens: Blender opens or imports it.
struct ForeignFormat {
    std::string_view ending, name;
    bool opens = true;
};
constexpr std::array<ForeignFormat, 22> kFormats{{{".usd", "USD"},
                                                  {".usda", "USD"},
                                                  {".usdc", "USD"},
                                                  {".usdz", "USD"},
                                                  {".obj", "Wavefront OBJ"},
                                                  {".fbx", "FBX"},
                                                  {".blend", "Blender"},
                                                  {".stl", "STL"},
                                                  {".ply", "PLY"},
                                                  {".dae", "COLLADA"},
                                                  {".abc", "Alembic"},
                                                  {".x3d", "X3D", false},
                                                  {".wrl", "VRML", false},
                                                  {".3ds", "3D Studio", false},
                                                  {".3mf", "3MF", false},
                                                  {".max", "3ds Max", false},
                                                  {".ma", "Maya", false},
                                                  {".mb", "Maya", false},
                                                  {".c4d", "Cinema 4D", false},
                                                  {".skp", "SketchUp", false},
                                                  {".pbrt", "pbrt", false},
                                                  {".xml", "XML", false}}};

}  // namespace

std::string foreign_scene_advice(const std::filesystem::path& file) {
    const std::string ending = lower(file.extension().string());
    for (const ForeignFormat& format : kFormats) {
        if (format.ending != ending) continue;
        return fmt::format(
            "is a file of {} by its ending; scenes are read as glTF 2.0, .gltf or .glb: {}",
            format.name,
            format.opens ? "open it or import it in Blender, then File > Export > glTF 2.0"
                         : "export it as that from a program that opens it");
    }
    return "";
}

}  // namespace petzval::io
