// SPDX-License-Identifier: Apache-2.0
// Scenes with glass: prisms, gems and caustics.
#include "tests/support/plan_scenes/kinds.h"

namespace petzval::test {
namespace {

constexpr float kTiny = 0.001f;  ///< dispersion of decoys

/// A glass that sends colours far apart, or hardly where a decoy shows it.
struct PlanGlass {
    float ior, dispersion;
    PlanGlass(PlanWorld& w, V2f px)
        : ior(w.dice.between(1.4f, 1.8f)),
          dispersion(w.decoy() && px.x > 0 ? kTiny : w.dice.log_between(2, 10)) {}
    /// Difference of its indices at the lines F and C: KHR_materials_dispersion is 20 / V.
    [[nodiscard]] float spread() const { return (ior - 1) * std::max(dispersion, 1.f) / 20; }
};

struct Directions {
    V3f forward, right, up;
};
/// forward: of the ray to a point; right: turned about it.
Directions directions(V3f at, float turn) {
    const V3f w = at.normalized(), x = w.cross(V3f(0, 1, 0)).normalized(), y = x.cross(w);
    return {w, x * std::cos(turn) + y * std::sin(turn), y * std::cos(turn) - x * std::sin(turn)};
}

/// A wedge that deviates rays to the right of its directions, and bright bars where they go.
void add_wedge(PlanWorld& w, V2f px, float size_px) {
    constexpr float kDistance_m = 4;
    const PlanGlass of(w, px);
    const V3f middle = w.view.at(px, kDistance_m);
    const auto [forward, right, up] = directions(middle, w.dice.between(0, 2 * kPi));
    const float half = size_px / 2 * w.view.pixel_m(kDistance_m);
    const float wedge = std::asin(w.dice.between(0.35f, 0.75f) / of.ior);
    const float exit = std::asin(of.ior * std::sin(wedge)), deviation = exit - wedge;
    std::vector<V3f> corners;
    for (const float back : {0.f, 1.f})
        for (const float v : {-half, half})
            for (const float u : {-half, half})
                corners.push_back(middle + right * u + up * v +
                                  forward * (back * (0.1f * half + (u + half) * std::tan(wedge))));
    w.body(corners,
           {{0, 1, 3, 2}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 3, 7, 5}},
           w.material(glass(of.ior, of.dispersion)));
    w.covers(middle, 1.5f * size_px);

    // The rainbow of a narrow bar is about as wide as the wedge.
    const float parted =
        of.spread() * std::sin(wedge) / (std::cos(exit) * std::pow(std::cos(deviation), 2.f));
    const float far = std::min(w.dice.between(0.4f, 1.5f) * 2 * half / parted, 3.f);
    const V3f seen = middle + forward * far + right * (far * std::tan(deviation));
    const int bar = w.material(random_glow(w.dice, 3, 100));
    const int count = w.dice.whole(1, 4);
    const bool squares = w.dice.chance(0.3f);
    for (int i = 0; i < count; ++i) {
        const float width = far * parted * w.dice.between(0.1f, 0.5f);
        const float length = squares ? width : 3 * half;
        const float offset = w.dice.between(-0.8f, 0.8f) * half * (count > 1 ? 1.f : 0.4f);
        const V3f at = seen + right * offset + forward * (0.001f * float(i));
        w.quad(at - right * (width / 2) - up * (length / 2), right * width, up * length, bar);
        w.covers(at, 0.6f * (length + width) / w.view.pixel_m(-at.z));
    }
}

/// A cut stone, and small lamps about it that its facets show.
void add_gem(PlanWorld& w, V2f px, float size_px) {
    constexpr float kDistance_m = 4;
    const PlanGlass of(w, px);
    const V3f middle = w.view.at(px, kDistance_m);
    const auto [forward, right, up] = directions(middle, w.dice.between(0, 2 * kPi));
    const float radius = size_px / 2 * w.view.pixel_m(kDistance_m);
    const int sides = w.dice.whole(3, 8);
    const V3f tilt = (up + forward * w.dice.between(-0.8f, 0.8f)).normalized();
    const V3f side = tilt.cross(right);
    std::vector<V3f> corners{middle + tilt * (radius * w.dice.between(0.4f, 1.f)),
                             middle - tilt * radius};
    for (int i = 0; i < sides; ++i) {
        const float angle = 2 * kPi * float(i) / float(sides);
        corners.push_back(middle + (right * std::cos(angle) + side * std::sin(angle)) * radius);
    }
    std::vector<std::vector<int>> faces;
    for (int i = 0; i < sides; ++i)
        for (const int tip : {0, 1}) faces.push_back({tip, 2 + i, 2 + (i + 1) % sides});
    w.body(corners, faces, w.material(glass(of.ior, of.dispersion)));
    w.covers(middle, 0.6f * size_px);
    const int count = w.dice.whole(6, 30);
    for (int i = 0; i < count; ++i) {  // most of them behind it, where facets look
        const V3f way = w.dice.anywhere();
        const V3f away =
            (forward * (0.75f * way.x + 0.25f) + right * way.y + up * way.z).normalized();
        const float far = radius * w.dice.between(3, 10),
                    half = far * w.dice.log_between(0.02f, 0.2f);
        const V3f at = middle + away * far;
        const V3f x = away.cross(V3f(0.3f, 1, 0.2f)).normalized(), y = x.cross(away);
        w.quad(at - x * half - y * half, x * (2 * half), y * (2 * half),
               w.material(random_glow(w.dice, 3, 100)));
        w.covers(at, 1.5f * half / w.view.pixel_m(-at.z));
    }
}

}  // namespace

void add_prisms(PlanWorld& w) {
    w.maybe_large(0.3f);
    const float fov = w.dice.between(20, 40);
    if (w.dice.chance(0.65f))
        w.pinhole(fov);
    else
        w.thin_lens(fov, w.dice.log_between(0.0005f, 0.01f), 4.f);
    if (w.decoy())
        w.soft_stage();
    else if (!w.large && w.dice.chance(0.7f))
        w.even_wall(w.dice.log_between(0.02f, 1));
    const int count = w.dice.whole(1, w.large ? 2 : 3);
    for (int i = 0; i < count; ++i) {
        const float size_px = w.large ? w.dice.log_between(6, 30) : w.dice.log_between(2, 14);
        V2f px{float(w.view.size.x) * w.dice.between(0.1f, 0.9f),
               float(w.view.size.y) * w.dice.between(0.15f, 0.85f)};
        if (w.decoy() && w.dice.chance(0.5f)) px.x = -3 * size_px;  // out of the frame
        if (w.dice.chance(0.65f))
            add_wedge(w, px, size_px);
        else
            add_gem(w, px, size_px);
    }
}

void add_caustics(PlanWorld& w) {
    w.maybe_large(0.2f, 320, 400);
    const float fov = w.large ? w.dice.between(80, 100) : w.dice.between(25, 35);
    constexpr float kDistance_m = 2.5f;
    if (w.dice.chance(0.6f))
        w.pinhole(fov);
    else
        w.thin_lens(fov, w.dice.log_between(0.002f, 0.02f), kDistance_m);
    // A floor that leans to the camera, and glass before its middle.
    const float half = w.large ? 0.5f : 1.2f;
    const V3f middle(0, 0, -kDistance_m);
    const V3f back = V3f{0, 1, -w.dice.between(0.3f, 2)}.normalized(), across(1, 0, 0);
    const V3f above = across.cross(back);
    w.quad(middle - across * half - back * half, across * (2 * half), back * (2 * half),
           w.material(matt(V3f(w.dice.between(0.3f, 0.8f)))));
    const bool disperses = w.dice.chance(0.7f);
    const float ior = w.dice.between(1.3f, 1.9f);
    const float dispersion = !disperses ? 0 : w.decoy() ? kTiny : w.dice.log_between(2, 10);
    const int material = w.material(glass(ior, dispersion));
    const float radius = half * w.dice.between(0.1f, 0.3f);
    const V3f aside = across * (half * w.dice.between(-0.3f, 0.3f));
    const V3f at = middle + aside + above * (radius * w.dice.between(1.1f, 3));
    if (w.dice.chance(0.6f)) {
        w.ball(at, radius, material, 24);
    } else {  // a bar with three sides
        std::vector<V3f> corners;
        const float turn = w.dice.between(0, 2 * kPi);
        for (const float end : {-1.5f, 1.5f})
            for (int i = 0; i < 3; ++i) {
                const float angle = turn + 2 * kPi * float(i) / 3;
                corners.push_back(at + back * (end * radius) +
                                  (across * std::cos(angle) + above * std::sin(angle)) * radius);
            }
        w.body(corners, {{0, 1, 2}, {3, 4, 5}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}}, material);
    }
    const float lamp = w.decoy() ? half / 2 : half * w.dice.log_between(0.02f, 0.1f);
    const V3f high = middle + across * (half * w.dice.between(-0.8f, 0.8f)) + above * (2.5f * half);
    const float nits = w.dice.between(0.5f, 2) * 6 * half * half / (lamp * lamp);
    w.quad(high - across * lamp - back * lamp, across * (2 * lamp), back * (2 * lamp),
           w.material(glowing(nits)));
    w.covers(middle, 1.5f * half / w.view.pixel_m(kDistance_m));
    w.covers(high, 1.5f * lamp / w.view.pixel_m(-high.z) + 2);
    w.covers(at, 1.5f * radius / w.view.pixel_m(-at.z));
}

}  // namespace petzval::test
