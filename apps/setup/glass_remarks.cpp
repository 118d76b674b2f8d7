// SPDX-License-Identifier: Apache-2.0
#include "apps/setup/glass_remarks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace petzval::apps {
namespace {

constexpr size_t kMostNamed = 3;
constexpr const char* kMakeThin =
    R"(make the glass thin by {"petzval": {"solid": false}} in its extras)";

std::string label_of(const Scene& scene, uint32_t material) {
    const std::string& name = scene.materials[material].name;
    return name.empty() ? fmt::format("material {}", material) : fmt::format("\"{}\"", name);
}

std::string label_of(VolumeFault fault) {
    switch (fault) {
        case VolumeFault::None:
            break;
        case VolumeFault::Open:
            return "open";
        case VolumeFault::InsideOut:
            return "inside out";
        case VolumeFault::Flat:
            return "flat";
        case VolumeFault::Holes:
            return "with holes in its coverage";
    }
    return "closed";
}

std::string label_of(const integrator::LostLight& lost) {
    switch (lost.kind) {
        case integrator::LostLight::Kind::Point:
            return fmt::format("point light {}", lost.light);
        case integrator::LostLight::Kind::Spot:
            return fmt::format("spot light {}", lost.light);
        case integrator::LostLight::Kind::Sun:
            return fmt::format("directional light {}", lost.light);
        case integrator::LostLight::Kind::Lamp:
            return fmt::format("a lamp of {:.2g} mm", 1e3 * lost.size);
        case integrator::LostLight::Kind::SkySpot:
            break;
    }
    return fmt::format("a spot of the sky of {:.2g}°", lost.size * 180 / double(kPi));
}

// The first few, and how many there are beside them.
template <class All, class Word>
std::string listed(const All& all, const Word& word) {
    std::vector<std::string> words;
    for (size_t i = 0; i < std::min(all.size(), kMostNamed); ++i) words.push_back(word(all[i]));
    std::string text = fmt::format("{}", fmt::join(words, ", "));
    if (all.size() > kMostNamed) text += fmt::format(" and {} more", all.size() - kMostNamed);
    return text;
}

std::string faulty_volumes_text(const Scene& scene, const std::vector<uint32_t>& faulty) {
    return fmt::format(
        "solid glass whose surface is not a closed volume: {}; where it overlaps other glass, "
        "absorption and refraction may be wrong; close all meshes of the material, with faces "
        "outwards, or {}",
        listed(faulty,
               [&](uint32_t m) {
                   return fmt::format("{} ({})", label_of(scene, m),
                                      label_of(scene.materials[m].volume_fault));
               }),
        kMakeThin);
}

std::string thin_bodies_text(const Scene& scene, const std::vector<uint32_t>& thin) {
    return fmt::format(
        "thin glass in the shape of a closed body: {}; it refracts nothing, as a soap bubble; for "
        "solid glass give the material a thickness (KHR_materials_volume; in Blender the input "
        "Thickness of a node group named \"glTF Material Output\"), or {{\"petzval\": "
        "{{\"solid\": true}}}} in its extras; false there keeps it thin without this message",
        listed(thin, [&](uint32_t m) { return label_of(scene, m); }));
}

std::string lost_light_text(const Scene& scene, const std::vector<integrator::LostLight>& lost) {
    std::vector<integrator::LostLight> by_share = lost;
    std::stable_sort(by_share.begin(), by_share.end(),
                     [](const auto& a, const auto& b) { return a.share > b.share; });
    return fmt::format(
        "no path finds light that comes through solid glass, or hardly one: {}; what it would "
        "light is too dark; give the light a size or a larger one, or {}",
        listed(by_share,
               [&](const integrator::LostLight& l) {
                   return fmt::format("{} behind {}", label_of(l), label_of(scene, l.glass));
               }),
        kMakeThin);
}

}  // namespace

std::vector<std::string> glass_remarks(const Scene& scene,
                                       const std::vector<integrator::LostLight>& lost) {
    std::vector<uint32_t> faulty, thin;
    for (uint32_t m = 0; m < scene.materials.size(); ++m) {
        if (scene.materials[m].volume_fault != VolumeFault::None) faulty.push_back(m);
        if (scene.materials[m].thin_body) thin.push_back(m);
    }
    std::vector<std::string> remarks;
    if (!thin.empty()) remarks.push_back(thin_bodies_text(scene, thin));
    if (!faulty.empty()) remarks.push_back(faulty_volumes_text(scene, faulty));
    if (!lost.empty()) remarks.push_back(lost_light_text(scene, lost));
    return remarks;
}

}  // namespace petzval::apps
