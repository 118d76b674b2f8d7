// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/materials/textures.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "io/image/picture_files.h"

namespace petzval::io {
namespace {

Wrap to_wrap(int mode) {
    if (mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return Wrap::ClampToEdge;
    if (mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT) return Wrap::MirroredRepeat;
    return Wrap::Repeat;
}

// Matrix offset * rotation * scale of KHR_texture_transform. It turns coordinates counter-clockwise
// as the image is seen, with v down: so its text says and so its example works out, not the GLSL in
// it.
void set_transform(TextureSlot& slot, const JsonCursor& info) {
    const auto [u, v, u2, v2] = numbers_of(info, SlotRow("offset"));
    const auto [su, sv, su2, sv2] = numbers_of(info, SlotRow("scale"));
    const double angle_rad = number_of(info, SlotRow("rotation"));
    const double c = std::cos(angle_rad), s = std::sin(angle_rad);
    const auto to_row = [](double a, double b, double d) {
        return std::array{static_cast<float>(a), static_cast<float>(b), static_cast<float>(d)};
    };
    slot.u_row = to_row(c * su, s * sv, u);
    slot.v_row = to_row(-s * su, c * sv, v);
}

/// What a normal map looks as if it had gone through, by the mean of its x and y, which is 1/2 for
/// normals that lean to all sides alike, and 0.735 or 0.214 after the curve of sRGB or back.
std::string fault_of_normals(const Image& image) {
    constexpr size_t most = 1 << 16;
    constexpr double tolerance = 0.03, least_blue = 0.85;
    const size_t count = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    const size_t step = 1 + count / most;
    std::array<double, 3> mean{};
    double taken = 0;
    for (size_t i = 0; i < count; i += step, ++taken)
        for (size_t c = 0; c < 3; ++c)
            mean[c] += std::visit(
                [&](const auto& texels) {
                    const double one =
                        std::is_same_v<std::decay_t<decltype(texels[0])>, float> ? 1 : 255;
                    return double(texels[4 * i + c]) / one;
                },
                image.texels);
    for (double& m : mean) m /= taken;
    const auto both_near = [&](double value) {
        return std::fabs(mean[0] - value) < tolerance && std::fabs(mean[1] - value) < tolerance &&
               mean[2] > least_blue;
    };
    const char* const went_through = both_near(0.735)   ? "encoded as sRGB"
                                     : both_near(0.214) ? "decoded from sRGB"
                                                        : nullptr;
    if (!went_through) return "";
    return fmt::format(
        "is a normal map whose x and y are {:.2f} on average instead of 0.5, as if it had been {}; "
        "all normals lean; export it as linear data",
        mean[0], went_through);
}

uint64_t bytes_of(const Image& image) {
    return std::visit([](const auto& texels) { return texels.size() * sizeof(texels[0]); },
                      image.texels);
}

}  // namespace

GltfTextures::GltfTextures(const GltfModel& gltf, std::vector<Image>& images, GltfTally& tally,
                           PictureBudget& pictures, DecodedImages& decoded)
    : gltf_(gltf),
      images_(images),
      tally_(tally),
      pictures_(pictures),
      decoded_(decoded),
      used_(gltf.source.images.size()) {}

TextureSlot GltfTextures::slot(const JsonCursor& material, const GltfProperty& property) {
    TextureSlot slot;
    at_place(material, property.place, [&](const JsonCursor& owner) {
        if (const auto info = owner.find_object(property.key)) slot = read_slot(*info, property);
    });
    return slot;
}

TextureSlot GltfTextures::read_slot(const JsonCursor& info, const GltfProperty& property) {
    const tinygltf::Texture& texture = gltf_.typed.textures.at(
        info.required_index("index", gltf_.typed.textures.size(), "texture"));
    const bool missing =
        texture.source < 0 || gltf_.source.images[static_cast<size_t>(texture.source)].empty();
    if (missing) {
        tally_.warnings.add(info.path(),
                            "its texture has no image that can be read; the slot is left without");
        return {};
    }

    TextureSlot slot;
    uint64_t uv_set = info.integer_or("texCoord", 0);
    if (const auto transform = info.extension("KHR_texture_transform")) {
        set_transform(slot, info);
        uv_set = transform->integer_or("texCoord", uv_set);
    }
    slot.uv_set = set_of(uv_set);
    slot.encoding = property.kind == PropertyKind::Colours ? Encoding::Srgb : Encoding::Linear;
    if (texture.sampler >= 0) {
        const auto& sampler = gltf_.typed.samplers.at(static_cast<size_t>(texture.sampler));
        slot.wrap_u = to_wrap(sampler.wrapS);
        slot.wrap_v = to_wrap(sampler.wrapT);
        slot.nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    const auto source = static_cast<size_t>(texture.source);
    slot.image = use_image(source);
    check_colours(source, info.path(), property);
    return slot;
}

uint8_t GltfTextures::set_of(uint64_t texcoord) {
    constexpr size_t always = std::tuple_size_v<decltype(Mesh::uv)>;
    if (texcoord < always) return static_cast<uint8_t>(texcoord);
    const auto at = std::find(more_sets_.begin(), more_sets_.end(), texcoord);
    const auto number = static_cast<size_t>(at - more_sets_.begin());
    if (at == more_sets_.end()) more_sets_.push_back(texcoord);
    return static_cast<uint8_t>(always + number);  // a material has some twenty slots
}

void GltfTextures::check_colours(size_t image, const std::string& slot,
                                 const GltfProperty& property) {
    Used& used = used_.at(image);
    const std::string place = json_path("images", image);
    if (used.remarks.inks)
        tally_.warnings.add(place,
                            "is in CMYK inks; its colours are guessed, as nothing says what "
                            "the inks look like; convert it to RGB");
    used.remarks.inks = false;
    if (property.kind == PropertyKind::Alpha) return;  // linear in an image of colours too
    const bool colours = property.kind == PropertyKind::Colours;
    if (colours && !used.remarks.other_space.empty()) {
        tally_.warnings.add(place,
                            "says that its colours are in {}; glTF takes them for sRGB, so they "
                            "are not those that were meant; convert it to sRGB",
                            used.remarks.other_space);
        used.remarks.other_space.clear();
    }
    std::string& first = colours ? used.colour_slot : used.data_slot;
    const std::string& other = colours ? used.data_slot : used.colour_slot;
    if (first.empty() && !other.empty())
        tally_.warnings.add(place,
                            "is read as colours in sRGB by {}, and as numbers by {}; one of them "
                            "is likely a mistake",
                            colours ? slot : other, colours ? other : slot);
    if (first.empty()) first = slot;
    if (std::string_view(property.key).ends_with("ormalTexture") && !used.normals_checked) {
        used.normals_checked = true;
        if (const std::string fault = fault_of_normals(images_[static_cast<size_t>(used.place)]);
            !fault.empty())
            tally_.warnings.add(place, fault);
    }
}

int32_t GltfTextures::use_image(size_t image) {
    Used& used = used_.at(image);
    if (used.place >= 0) return used.place;
    const std::string place = json_path("images", image);
    if (const auto known = decoded_.images.find(image); known != decoded_.images.end()) {
        images_.push_back(std::move(known->second.image));
        (void)pictures_.take(bytes_of(images_.back()), 0);  // there was room when it was decoded
        used.remarks = std::move(known->second.remarks);
        decoded_.images.erase(known);
    } else {
        images_.push_back(
            decode_image(gltf_.source.images[image], gltf_.file, place, pictures_, used.remarks));
    }
    origins_.push_back({image, used.remarks});
    const JsonCursor json(gltf_.source.json["images"][image], gltf_.file, place);
    const std::string uri = json.text_or("uri", "");
    images_.back().name = json.text_or("name", uri.starts_with("data:") ? "" : uri.c_str());
    return used.place = static_cast<int32_t>(images_.size()) - 1;
}

}  // namespace petzval::io
