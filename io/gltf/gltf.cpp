// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/gltf.h"

#include <tiny_gltf.h>

#include "io/base/error.h"
#include "io/gltf/exporter/lost.h"
#include "io/gltf/geometry/place.h"
#include "io/gltf/image_light.h"
#include "io/gltf/info.h"
#include "io/gltf/lights.h"
#include "io/gltf/validate/extras.h"

namespace petzval::io {

struct GltfReader::Impl {
    std::string name;
    GltfChoices choices;
    GltfSource source;
    nlohmann::json stored;  ///< the JSON as the file has it, where it is posed
    DecodedImages decoded;
    std::vector<GltfTextures::Origin> origins;  ///< of the images of the last scene
};

GltfReader::GltfReader(const std::filesystem::path& path, FileScope scope,
                       const GltfChoices& choices)
    : impl_(std::make_unique<Impl>()) {
    naming_file(path.string(), [&] {
        impl_->name = path.string();
        impl_->choices = choices;
        impl_->source =
            read_gltf_source(path, scope, choices.animation, choices.checks_all_animations);
        if (choices.animation) impl_->stored = impl_->source.json;
    });
}

GltfReader::~GltfReader() = default;

GltfFile GltfReader::load(PictureBudget& pictures, double time_s) {
    Impl& d = *impl_;
    std::optional<AnimationChoice>& animation = d.choices.animation;
    return naming_file(d.name, [&] {
        if (animation) {
            animation->time_s = time_s;
            d.source.json = d.stored;
            pose_source(d.source, *animation);
        }
        const tinygltf::Model model = parse_model(d.source);
        const GltfModel gltf{d.source, model, d.name};

        GltfFile file;
        GltfTally tally;
        const GltfNodes nodes = flatten_nodes(gltf, d.choices.scene);
        NodeMotion motion;
        if (animation)
            motion = NodeMotion(d.source.json, d.source.clips, *animation,
                                {nodes.order, nodes.parent, nodes.to_world});
        tally.motion_unseen = motion.unseen();
        if (animation && animation->open_s > 0)
            tally.held = held_while_open(d.source.clips, *animation);
        GltfMaterials materials(gltf, file.scene, tally, pictures, d.decoded);
        place_meshes(gltf, nodes, motion, GltfVariant(gltf, d.choices.variant), materials,
                     file.scene, tally, d.choices.point_line_radius_m);
        d.origins = materials.textures().origins();
        const std::vector<BallLamp> lamps = read_lights(gltf, nodes, motion, file.scene, tally);
        const std::vector<FlatLamp> flat = read_flat_lamps(gltf, nodes, motion, file.scene, tally);
        read_profile_lights(gltf, nodes, motion, file.scene, tally);
        if (auto sky = read_image_light(gltf, nodes, tally, pictures))
            file.scene.sky = *std::move(sky);
        file.cameras = read_cameras(gltf, nodes, motion, tally);
        if (nodes.scene >= 0) {
            const auto number = static_cast<size_t>(nodes.scene);
            file.extras = scene_extras(
                JsonCursor(d.source.json["scenes"][number], d.name, json_path("scenes", number)));
        }
        file.lost = lost_by_exporter(d.source.json, nodes.in_scene,
                                     file.extras.sky || !file.scene.sky.black());
        file.lamp_unit_doubt = lamp_unit_doubt(d.source.json);

        file.hash = d.source.hash;
        file.files = d.source.files;
        file.warnings = d.source.warnings.lines();
        describe(gltf, tally, animation, file);
        add_lamps(file.scene, lamps);
        add_lamps(file.scene, flat);
        return file;
    });
}

void GltfReader::give_back(std::vector<Image>&& images) {
    Impl& d = *impl_;
    for (size_t i = 0; i < std::min(images.size(), d.origins.size()); ++i)
        d.decoded.images[d.origins[i].number] = {std::move(images[i]),
                                                 std::move(d.origins[i].remarks)};
    d.origins.clear();
}

GltfFile load_gltf(const std::filesystem::path& path, FileScope scope, PictureBudget& pictures,
                   const GltfChoices& choices) {
    return GltfReader(path, scope, choices)
        .load(pictures, choices.animation ? choices.animation->time_s : 0);
}

GltfFile load_gltf(const std::filesystem::path& path) {
    PictureBudget pictures;
    return load_gltf(path, FileScope::Anywhere, pictures);
}

}  // namespace petzval::io
