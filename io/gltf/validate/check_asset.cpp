// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <array>
#include <charconv>

#include "io/base/json_parse.h"
#include "io/gltf/validate/check.h"

namespace petzval::io {
namespace {

constexpr std::array collections = {"accessors", "animations", "buffers", "bufferViews", "cameras",
                                    "images",    "materials",  "meshes",  "nodes",       "samplers",
                                    "scenes",    "skins",      "textures"};

struct Version {
    int major = 0, minor = 0;
    auto operator<=>(const Version&) const = default;
};

Version read_version(const JsonCursor& asset, const char* key) {
    const std::string text = asset.text(key);
    const char* end = text.data() + text.size();
    Version version;
    const auto dot = std::from_chars(text.data(), end, version.major);
    const bool has_dot = dot.ec == std::errc() && dot.ptr != end && *dot.ptr == '.';
    const auto last = has_dot ? std::from_chars(dot.ptr + 1, end, version.minor) : dot;
    if (!has_dot || last.ec != std::errc() || last.ptr != end)
        asset.fail(key, "must be a version such as \"2.0\", but is \"{}\"", printable(text));
    return version;
}

}  // namespace

void check_asset(const GltfCheck& check) {
    const JsonCursor asset = check.root.object("asset");
    const Version version = read_version(asset, "version");
    if (version.major != 2)
        asset.fail("version", "is {}.{}; only glTF 2 can be read", version.major, version.minor);
    if (!asset.has("minVersion")) return;
    const Version least = read_version(asset, "minVersion");
    if (least > version) asset.fail("minVersion", "is more than the version");
    if (least > Version{2, 0})
        asset.fail("minVersion", "is {}.{}; only glTF 2.0 can be read", least.major, least.minor);
}

void check_collections(const GltfCheck& check) {
    for (const char* kind : collections)
        for (const JsonCursor& object : check.root.objects(kind)) (void)object.text_or("name", "");
}

}  // namespace petzval::io
