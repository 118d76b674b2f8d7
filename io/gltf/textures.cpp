// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/textures.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include "io/base/json_parse.h"
#include "io/image/picture_files.h"

namespace petzval {
namespace {

constexpr uint64_t kUvSets = 2;

Wrap to_wrap(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::ClampToEdge;
    if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::MirroredRepeat;
    return Wrap::Repeat;
}

// Matrix offset * rotation * scale of KHR_texture_transform. It turns coordinates counter-clockwise
// as the image is seen, with v down: so its text says and so its example works out, not the GLSL in
// it.
void set_transform(TextureSlot& slot, const JsonCursor& transform) {
    const auto offset = transform.numbers("offset", 2), scale = transform.numbers("scale", 2);
    const double angle_rad = transform.number_or("rotation", 0);
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const double su = scale.empty() ? 1 : scale[0], sv = scale.empty() ? 1 : scale[1];
    const double u = offset.empty() ? 0 : offset[0], v = offset.empty() ? 0 : offset[1];
    const auto to_row = [](double a, double b, double d) {
        return std::array{static_cast<float>(a), static_cast<float>(b), static_cast<float>(d)};
    };
    slot.u_row = to_row(c * su, s * sv, u);
    slot.v_row = to_row(-s * su, c * sv, v);
}

}  // namespace

GltfTextures::GltfTextures(const GltfModel& gltf, std::vector<Image>& images, GltfTally& tally,
                           PictureBudget& pictures)
    : gltf_(gltf),
      images_(images),
      tally_(tally),
      pictures_(pictures),
      used_(gltf.source.images.size(), -1) {}

TextureSlot GltfTextures::slot(const JsonCursor& parent, const char* key, Encoding encoding) {
    const auto info = parent.find_object(key);
    if (!info) return {};
    const tinygltf::Texture& texture = gltf_.typed.textures.at(
        info->required_index("index", gltf_.typed.textures.size(), "texture"));
    const bool missing =
        texture.source < 0 || gltf_.source.images[static_cast<size_t>(texture.source)].empty();
    if (missing) {
        tally_.warnings.push_back(info->path() +
                                  ": its texture has no image that can be read; "
                                  "the slot is left without");
        return {};
    }

    TextureSlot slot;
    uint64_t uv_set = info->integer_or("texCoord", 0);
    if (const auto transform = info->extension("KHR_texture_transform")) {
        set_transform(slot, *transform);
        uv_set = transform->integer_or("texCoord", uv_set);
    }
    if (uv_set >= kUvSets) {
        tally_.warnings.push_back(fmt::format(
            "{}: uses TEXCOORD_{}, of which only 0 and 1 are read; the slot is left without",
            info->path(), uv_set));
        return {};
    }
    slot.uv_set = static_cast<uint8_t>(uv_set);
    slot.encoding = encoding;
    if (texture.sampler >= 0) {
        const auto& sampler = gltf_.typed.samplers.at(static_cast<size_t>(texture.sampler));
        slot.wrap_u = to_wrap(sampler.wrapS);
        slot.wrap_v = to_wrap(sampler.wrapT);
        slot.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    slot.image = use_image(static_cast<size_t>(texture.source));
    return slot;
}

int32_t GltfTextures::use_image(size_t image) {
    int32_t& used = used_.at(image);
    if (used >= 0) return used;
    const std::string place = json_path("images", image);
    images_.push_back(decode_image(gltf_.source.images[image], gltf_.file, place, pictures_));
    const JsonCursor json(gltf_.source.json["images"][image], gltf_.file, place);
    const std::string uri = json.text_or("uri", "");
    images_.back().name = json.text_or("name", uri.starts_with("data:") ? "" : uri.c_str());
    return used = static_cast<int32_t>(images_.size()) - 1;
}

}  // namespace petzval
