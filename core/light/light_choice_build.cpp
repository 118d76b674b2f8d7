// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_choice.h"

#include <algorithm>
#include <limits>

#include "core/light/light_sampling.h"
#include "core/scene/motion.h"

namespace petzval {
namespace {

// Power of a light, bounded so that the sum of all stays finite however bright the file says a lamp
// is.
float finite(const Scene& scene, float power) {
    const float most = std::numeric_limits<float>::max() / static_cast<float>(scene.lights.size());
    return power <= most ? power : most;
}

// Share that each of two groups of lights has at least, whatever a pilot found: what it missed has
// a weight of 20 at most.
constexpr float kLeastShare = 0.05f;

// Bounds of a light that is first like one and then like the other.
LightBounds over_both(const LightBounds& a, const LightBounds& b) {
    LightBounds both = a | b;
    both.power = a.power;
    return both;
}

struct BoundsOf {
    const Scene& scene;
    float power;  ///< light_power, above 0

    [[nodiscard]] LightBounds bounds_of(const Beam& beam, const Box3f& box) const {
        const float inner = std::acos(beam.cos_inner), outer = std::acos(beam.cos_outer);
        return LightBounds{box, beam.direction, inner, outer - inner, false, power};
    }
    std::optional<LightBounds> operator()(const PointLight& light) const {
        return LightBounds{Box3f(light.position), V3f(0, 0, 1), kPi, kPi / 2, false, power};
    }
    std::optional<LightBounds> operator()(const SpotLight& light) const {
        return bounds_of({light.direction, light.cos_inner, light.cos_outer},
                         Box3f(light.position));
    }
    std::optional<LightBounds> operator()(const ProfileLight& light) const {
        const float reach = scene.profiles[light.profile].reach_rad();
        return LightBounds{Box3f(light.position), light.f, reach, 0, false, power};
    }
    std::optional<LightBounds> operator()(const TriangleLight& light) const {
        const size_t steps = step_count(scene, light.instance);
        LightBounds all = bounds_of(light, step_time(0, steps));
        for (size_t i = 1; i < steps; ++i)
            all = over_both(all, bounds_of(light, step_time(i, steps)));
        return all;
    }
    [[nodiscard]] LightBounds bounds_of(const TriangleLight& light, float time) const {
        const auto corner = triangle_corners(scene, light.instance, light.triangle, time);
        Box3f box;
        for (const V3f& c : corner) box.extendBy(c);
        const Instance& instance = scene.instances[light.instance];
        const Material& material = scene.materials[scene.meshes[instance.mesh].material];
        if (const auto& beam = material.beam) return bounds_of(*beam, box);
        const V3f front = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
        const bool flips = flips_at(scene, light.instance, time);
        return LightBounds{box, flips ? -front : front, 0, kPi / 2, material.double_sided, power};
    }
    std::optional<LightBounds> operator()(const SunLight&) const { return std::nullopt; }
    std::optional<LightBounds> operator()(const SkyLight&) const { return std::nullopt; }
};

std::optional<LightBounds> bounds_of_light(const Scene& scene, uint32_t light, float power) {
    const BoundsOf bounds{scene, power};
    const auto* const steps = steps_of_light(scene, light);
    if (!steps) return std::visit(bounds, scene.lights[light]);
    std::optional<LightBounds> all;
    for (const Light& step : *steps) {
        const auto one = std::visit(bounds, step);
        if (one) all = all ? over_both(*all, *one) : *one;
    }
    return all;
}

// Illuminance, lux, on a surface that faces a light outside the tree.
float illuminance(const Scene& scene, const Light& light) {
    if (const auto* sun = std::get_if<SunLight>(&light)) return luminance(sun->illuminance_lx);
    return kPi * scene.sky.drawn_luminance();
}

}  // namespace

LightChoice::LightChoice(const Scene& scene, LightChoiceKind kind) {
    std::vector<float> weights;
    weights.reserve(scene.lights.size());
    for (const Light& light : scene.lights) {
        const float power = finite(scene, light_power(scene, light));
        weights.push_back(kind == LightChoiceKind::Uniform && power > 0.f ? 1.f : power);
    }
    if (kind == LightChoiceKind::Tree) plant(scene, weights);
    if (std::any_of(weights.begin(), weights.end(), [](float w) { return w > 0.f; }))
        choice_ = Piecewise1D(weights);
}

// Moves the lights that have a position from the weights into the tree.
void LightChoice::plant(const Scene& scene, std::span<float> power) {
    std::vector<std::optional<LightBounds>> bounds(power.size());
    float outside = 0;
    for (size_t i = 0; i < power.size(); ++i) {
        if (!(power[i] > 0.f)) continue;
        bounds[i] = bounds_of_light(scene, static_cast<uint32_t>(i), power[i]);
        if (!bounds[i]) outside += finite(scene, illuminance(scene, scene.lights[i]));
    }
    if (std::none_of(bounds.begin(), bounds.end(), [](const auto& b) { return b.has_value(); }))
        return;
    for (size_t i = 0; i < power.size(); ++i)
        if (bounds[i]) power[i] = 0.f;
    tree_ = std::make_shared<const LightTree>(bounds, outside);
}

LightChoice LightChoice::for_pilot() const {
    LightChoice even = *this;
    even.least_share_ = 0.5f;
    return even;
}

LightChoice LightChoice::fitted(std::span<const LightRecord> records) const {
    LightChoice fitted = *this;
    fitted.shares_ = LightShares(records);
    fitted.least_share_ = kLeastShare;
    return fitted;
}

LightRecord LightChoice::record(const std::optional<uint32_t>& light, const LightReceiver& receiver,
                                float found) const {
    const LightTree::Strength strength = tree_->strength(receiver);
    const bool outside = light && choice_.probability(*light) > 0.f;
    return {receiver.p, outside ? LightGroup::Outside : LightGroup::Inside,
            outside ? strength.outside : strength.inside, found};
}

}  // namespace petzval
