// SPDX-License-Identifier: Apache-2.0
#include "core/light/light_tree.h"

#include <algorithm>

namespace petzval {
namespace {

// Slack of angular bounds: sines come from cosines near 1 with an error of up to sqrt(2^-23) =
// 3.5e-4. What is nearer to a bound than this may be inside it, and has this cosine at least.
constexpr float kSlack = 1e-3f;

inline f8 sine_of(f8 cosine) {
    return sqrt(max(1.f - cosine * cosine, f8{}));
}
// Mean cosine of a normal with the directions to a sphere, those behind it counted as 0: near
// enough where that is known (a point: the cosine; all around: 1/4; a hemisphere across the normal:
// 1/4).
inline f8 mean_cosine(f8 cos_normal, f8 cos_sphere) {
    const f8 length = 0.5f + 0.5f * cos_sphere, mean = cos_normal * length;
    const f8 variance = 0.25f * (1.f - length * length) + kSlack * kSlack;
    return 0.5f * (mean + sqrt(mean * mean + variance));
}

}  // namespace

// Importance of a node's children, after Conty Estevez and Kulla 2018, equation 3: intensity times
// the cosines at both ends over the squared distance, 0 where the least angles over sphere and cone
// leave nothing. The receiver's cosine is the mean over the sphere, not the greatest: clusters all
// around would count four times.
f8 LightTree::weigh(const Node& n, const LightReceiver& r) {
    const f8 x = n.x - r.p.x, y = n.y - r.p.y, z = n.z - r.p.z;
    const f8 centre2 = x * x + y * y + z * z, radius2 = n.radius * n.radius;
    const m8 inside = centre2 <= radius2;
    // No nearer than the radius: within the sphere a light may be anywhere.
    f8 distance2 = max(max(centre2, radius2), splat8(1e-24f));
    distance2 = distance2 < 1e30f ? distance2 : splat8(1e30f);
    const f8 scale = 1.f / sqrt(distance2);
    const f8 sin_sphere = n.radius * scale;
    const f8 cos_sphere = inside ? splat8(-1.f) : sine_of(sin_sphere);

    const f8 along = (n.axis_x * x + n.axis_y * y + n.axis_z * z) * scale;
    const f8 cos_axis = n.two_sided ? abs(along) : -along;
    const f8 sin_axis = sine_of(cos_axis);
    const m8 in_spread = cos_axis > n.cos_spread;
    const f8 cos_off = in_spread ? splat8(1.f) : cos_axis * n.cos_spread + sin_axis * n.sin_spread;
    const f8 sin_off = in_spread ? f8{} : sin_axis * n.cos_spread - cos_axis * n.sin_spread;
    const f8 cos_light = cos_off * cos_sphere + sin_off * sin_sphere;
    const m8 shines = (cos_off > cos_sphere) | (cos_light > n.cos_reach - kSlack);
    const f8 emitted = cos_off > cos_sphere ? splat8(1.f) : max(cos_light, splat8(kSlack));

    const f8 facing = (x * r.normal.x + y * r.normal.y + z * r.normal.z) * scale;
    const f8 cos_normal = r.both_sides ? abs(facing) : facing;
    const f8 cos_receiver = cos_normal * cos_sphere + sine_of(cos_normal) * sin_sphere;
    const m8 arrives = (cos_normal > cos_sphere) | (cos_receiver > -kSlack);
    const f8 weight = n.intensity * emitted * mean_cosine(cos_normal, cos_sphere) * (scale * scale);
    return shines & arrives ? weight : f8{};
}

float LightTree::outside_beside(float inside, const OutsideShare& known) const {
    if (!(outside_ > 0.f)) return 0.f;
    if (!(inside > 0.f)) return 1.f;
    const float outside = std::clamp(known.factor * outside_, 1e-30f, 1e30f);
    const float least = known.least * (inside + outside), rest = 1.f - 2.f * known.least;
    return inside * ((least + rest * outside) / (least + rest * inside));
}

LightTree::Strength LightTree::strength(const LightReceiver& receiver) const {
    return {hsum(weigh(nodes_[0], receiver)), outside_};
}

std::optional<LightTree::Pick> LightTree::pick(float u, const LightReceiver& receiver,
                                               const OutsideShare& known) const {
    float probability = 1.f, outside = 0.f;
    for (uint32_t node = 0;;) {
        const Node& n = nodes_[node];
        const f8 weight = weigh(n, receiver);
        const float inside = hsum(weight);
        outside = node == 0 ? outside_beside(inside, known) : 0.f;
        const float sum = outside + inside;
        float left = u * sum;
        if (left < outside) return Pick{kOutside, outside / sum, left / outside};
        left -= outside;
        int child = -1;
        for (int i = 0; i < 8; ++i) {
            if (!(weight[i] > 0.f)) continue;
            if (child >= 0) left -= weight[child];
            child = i;
            if (left < weight[i]) break;
        }
        if (child < 0) return std::nullopt;
        probability *= weight[child] / sum;
        u = std::clamp(left / weight[child], 0.f, kOneMinus);
        if (n.is_light >> child & 1) return Pick{n.child[child], probability, u};
        node = n.child[child];
    }
}

float LightTree::probability(uint32_t light, const LightReceiver& receiver,
                             const OutsideShare& known) const {
    if (light == kOutside) {
        const float inside = hsum(weigh(nodes_[0], receiver));
        const float outside = outside_beside(inside, known), sum = outside + inside;
        return sum > 0.f ? outside / sum : 0.f;
    }
    float probability = 1.f;
    for (uint32_t at = place_[light]; at != kOutside; at = parent_[at / 8]) {
        const f8 weight = weigh(nodes_[at / 8], receiver);
        const float inside = hsum(weight);
        const float sum = inside + (at < 8 ? outside_beside(inside, known) : 0.f);
        const float chosen = weight[at % 8];
        if (!(chosen > 0.f)) return 0.f;
        probability *= chosen / sum;
    }
    return place_[light] == kOutside ? 0.f : probability;
}

}  // namespace petzval
