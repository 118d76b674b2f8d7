// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/gltf.h"

#include <tiny_gltf.h>

#include "io/base/error.h"
#include "io/gltf/image_light.h"
#include "io/gltf/info.h"
#include "io/gltf/lights.h"
#include "io/gltf/place.h"

namespace petzval {

namespace {

GltfFile load(const std::filesystem::path& path, FileScope scope, PictureBudget& pictures,
              const GltfChoices& choices) {
    const GltfSource source = read_gltf_source(path, scope, choices.animation);
    const tinygltf::Model model = parse_model(source);
    const std::string name = path.string();
    const GltfModel gltf{source, model, name};

    GltfFile file;
    GltfTally tally;
    const GltfNodes nodes = flatten_nodes(gltf, choices.scene);
    NodeMotion motion;
    if (choices.animation)
        motion = NodeMotion(source.json, source.clips, *choices.animation, nodes.to_world);
    tally.keys_between_steps = motion.keys_between_steps();
    GltfMaterials materials(gltf, file.scene, tally, pictures);
    place_meshes(gltf, nodes, motion, GltfVariant(gltf, choices.variant), materials, file.scene,
                 tally, choices.point_line_radius_m);
    const std::vector<BallLamp> lamps = read_lights(gltf, nodes, motion, file.scene, tally);
    read_profile_lights(gltf, nodes, motion, file.scene, tally);
    if (auto sky = read_image_light(gltf, nodes, tally, pictures)) file.scene.sky = *std::move(sky);
    file.cameras = read_cameras(gltf, nodes, motion, tally);

    file.hash = source.hash;
    file.files = source.files;
    file.warnings = source.warnings.lines();
    describe(gltf, tally, choices.animation, file);
    add_lamps(file.scene, lamps);
    return file;
}

}  // namespace

GltfFile load_gltf(const std::filesystem::path& path, FileScope scope, PictureBudget& pictures,
                   const GltfChoices& choices) {
    return naming_file(path.string(), [&] { return load(path, scope, pictures, choices); });
}

GltfFile load_gltf(const std::filesystem::path& path) {
    PictureBudget pictures;
    return load_gltf(path, FileScope::Anywhere, pictures);
}

}  // namespace petzval
