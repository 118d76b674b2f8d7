// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "io/base/error.h"
#include "io/base/json_cursor.h"
#include "io/gltf/lights.h"
#include "io/gltf/materials/spectral.h"
#include "io/ies/ies.h"

namespace petzval::io {
namespace {

/// Unit axes of a node, x and y across the way it looks, -z. Mirrored where its matrix mirrors.
struct Axes {
    V3d x, y, forward;
};

std::optional<Axes> axes_of(const M44d& to_world) {
    if (is_singular(to_world)) return std::nullopt;
    const V3d z = row(to_world, 2).normalized();
    const V3d x = row(to_world, 1).cross(z).normalized();
    return Axes{relative_determinant(to_world) < 0 ? -x : x, z.cross(x), -z};
}

Rgb factor_of(const JsonCursor& light) {
    const auto multiplier = static_cast<float>(light.number_or("multiplier", 1));
    const auto colour = light.numbers("color", 3);
    Rgb factor(multiplier);
    for (int i = 0; i < 3 && !colour.empty(); ++i)
        factor.v[i] *= static_cast<float>(std::min(colour[static_cast<size_t>(i)], 1.));
    return factor;
}

/// Reads each profile when the first node asks for it.
class Profiles {
  public:
    Profiles(const GltfModel& gltf, Scene& scene, GltfTally& tally)
        : gltf_(gltf), scene_(scene), tally_(tally) {}

    /// Index in the scene of a profile of the file; nothing for one that is not there.
    std::optional<uint32_t> use(size_t number) {
        const std::vector<uint8_t>& bytes = gltf_.source.light_profiles.at(number);
        if (bytes.empty()) return std::nullopt;
        const auto [at, is_new] =
            used_.try_emplace(number, static_cast<uint32_t>(scene_.profiles.size()));
        if (is_new) read(bytes, json_path("extensions", "EXT_lights_ies", "lights", number));
        return at->second;
    }

  private:
    void read(const std::vector<uint8_t>& bytes, const std::string& place) {
        IesFile found = parse_ies({reinterpret_cast<const char*>(bytes.data()), bytes.size()},
                                  gltf_.file, place);
        for (const std::string& remark : found.remarks) tally_.warnings.add(place, remark);
        scene_.profiles.push_back(std::move(found.profile));
    }

    const GltfModel& gltf_;
    Scene& scene_;
    GltfTally& tally_;
    std::map<size_t, uint32_t> used_;
};

}  // namespace

void read_profile_lights(const GltfModel& gltf, const GltfNodes& nodes, const NodeMotion& motion,
                         Scene& scene, GltfTally& tally) {
    const JsonCursor root(gltf.source.json, gltf.file);
    const auto definitions = root.extension("EXT_lights_ies");
    if (!definitions) return;
    const auto lights = definitions->objects("lights"), json = root.objects("nodes");
    GltfSpectral spectral(scene, tally);
    Profiles profiles(gltf, scene, tally);
    for (int node : nodes.in_scene) {
        const auto index = static_cast<size_t>(node);
        const auto light = json[index].extension("EXT_lights_ies");
        if (!light) continue;
        const size_t number = light->required_index("light", lights.size(), "light");
        const Rgb factor = factor_of(*light);
        if (!(hmax(factor.v) > 0)) continue;
        const auto profile = profiles.use(number);
        if (!profile) continue;
        const int32_t illuminant = spectral.illuminant(lights[number]);
        const auto make = [&](const M44d& to_world) -> std::optional<Light> {
            const auto axes = axes_of(to_world);
            if (!axes) return {};
            return ProfileLight{V3f(row(to_world, 3)),
                                V3f(axes->x),
                                V3f(axes->y),
                                V3f(axes->forward),
                                factor,
                                *profile,
                                illuminant};
        };
        const auto made = make(nodes.to_world[index]);
        if (!made) {
            tally.warnings.add(json_path("nodes", node), "its light is left out");
            continue;
        }
        scene.lights.push_back(*made);
        move_last_light(motion, node, scene, tally, make);
    }
}

}  // namespace petzval::io
