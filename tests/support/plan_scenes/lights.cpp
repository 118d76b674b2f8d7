// SPDX-License-Identifier: Apache-2.0
// Scenes of small lights: lamps out of focus, glints, and spectra of lamps and metals.
#include "tests/support/plan_scenes/kinds.h"

namespace petzval::test {
namespace {

struct FastLens {
    const char* name;
    float focal_mm, fstop, nearest_m;
};
constexpr std::array<FastLens, 5> kFast{{{"takumar-50mm-f1.2", 50, 1.2f, 0.6f},
                                         {"tessar-100mm-f2.8", 100, 2.8f, 1.2f},
                                         {"biotar-58mm-f1.4", 58, 1.4f, 0.8f},
                                         {"primoplan-58mm-f1.5", 58, 1.5f, 0.8f},
                                         {"double-gauss-100mm-f2", 100, 2, 1.2f}}};

/// Sets a fast lens; returns its diameter and focus in metres.
V2f set_fast_lens(PlanWorld& w, float farther) {
    if (w.dice.chance(0.6f)) {
        const FastLens& lens = w.dice.pick(kFast);
        const float focus_m = lens.nearest_m * w.dice.between(1, farther);
        w.real_lens(lens.name, lens.focal_mm, focus_m);
        return {lens.focal_mm / 1000 / lens.fstop, focus_m};
    }
    const float radius = w.dice.log_between(0.01f, 0.05f), focus_m = w.dice.between(0.6f, 2);
    w.thin_lens(25, radius, focus_m);
    return {2 * radius, focus_m};
}

constexpr std::array<V3f, 4> kSaturated{{V3f(0.9f, 0.04f, 0.02f), V3f(0.03f, 0.8f, 0.05f),
                                         V3f(0.03f, 0.05f, 0.9f), V3f(0.9f, 0.6f, 0.02f)}};
constexpr std::array<const char*, 4> kMetals{"ag", "al", "au", "cu"};

/// A lamp with a spectrum of its own.
nlohmann::json spiky(PlanWorld& w, float nits, V3f colour = V3f(1.f)) {
    return with_extra(glowing(nits, colour), "illuminant", w.dice.chance(0.7f) ? "f11" : "a");
}

nlohmann::json measured_metal(PlanWorld& w) {
    const nlohmann::json metal = shiny_metal(V3f(0.9f), w.dice.between(0.05f, 0.5f));
    return with_extra(metal, "metal", w.dice.pick(kMetals));
}

/// A box, open to the camera, of deep colours, with a lamp at its ceiling.
void add_box(PlanWorld& w) {
    const float depth = 4,
                half = w.large ? 0.12f : 0.48f * float(w.view.size.y) * w.view.pixel_m(depth);
    const V3f m = w.large ? w.view.at({float(w.view.size.x) * w.dice.between(0.2f, 0.8f),
                                       float(w.view.size.y) * w.dice.between(0.2f, 0.8f)},
                                      depth)
                          : V3f(0, 0, -depth);
    const V3f x(2 * half, 0, 0), y(0, 2 * half, 0), z(0, 0, -2 * half);
    const V3f corner = m - V3f(half, half, 0);
    const V3f main_colour = w.dice.pick(kSaturated);
    const auto wall = [&] {
        if (w.decoy()) return w.material(matt(V3f(0.5f, 0.5f, 0.55f)));
        return w.material(matt(w.dice.chance(0.5f) ? main_colour : w.dice.pick(kSaturated)));
    };
    w.quad(corner, x, z, wall());
    w.quad(corner + y, x, z, wall());
    w.quad(corner, y, z, wall());
    w.quad(corner + x, y, z, wall());
    w.quad(corner + z, x, y, wall());
    const float lamp = half * w.dice.between(0.1f, 0.5f);
    w.quad(m + V3f(-lamp, 0.98f * half, -half - lamp), {2 * lamp, 0, 0}, {0, 0, 2 * lamp},
           w.material(w.decoy() ? with_extra(glowing(10), "illuminant", "d65")
                                : spiky(w, 4 * half * half / (lamp * lamp))));
    if (w.dice.chance(0.5f))
        w.ball(m + V3f{half * w.dice.between(-0.5f, 0.5f), -0.6f * half, -half}, 0.4f * half,
               w.material(measured_metal(w)));
    w.covers(m, 1.45f * half / w.view.pixel_m(depth));
}

}  // namespace

void add_lamps(PlanWorld& w) {
    w.maybe_large(0.25f, 320, 400);
    const auto [diameter, focus_m] = [&] {
        const V2f lens = set_fast_lens(w, 2);
        return std::array{lens.x, lens.y};
    }();
    const float even = w.large ? 0 : w.dice.log_between(0.02f, 0.5f);
    if (even > 0) w.even_wall(even);
    if (w.decoy()) w.soft_stage();
    const int count =
        w.large ? w.dice.whole(1, 3) : static_cast<int>(std::lround(w.dice.log_between(1, 60)));
    const float depth = w.decoy() ? focus_m : w.dice.log_between(3, 15);
    // Each becomes a disc, so many times as bright as what lies behind. A ray to the disc meets the
    // lamp once in 30 to 3000 times.
    const float disc_m = diameter * (depth - focus_m) / focus_m;
    const float hit = w.dice.log_between(3e-4f, 3e-2f);
    const float size_m = w.decoy() ? 0.2f : std::clamp(disc_m * std::sqrt(hit), 0.0005f, 0.02f);
    const float nits = w.dice.log_between(2, 100) * std::max(even, 0.1f) *
                       std::max(0.785f * disc_m * disc_m / (size_m * size_m), 1.f);
    // A far brighter lamp that nobody sees must not hide them; nor an even texture.
    const bool decoyed = w.dice.chance(0.3f), textured = w.dice.chance(0.3f);
    if (decoyed)
        w.quad({-0.1f, 2, 1}, {0.2f, 0, 0}, {0, 0, 0.2f},
               w.material(glowing(nits * w.dice.log_between(100, 1e5f))));
    const int white = textured ? w.texture(2, 2, std::vector<V3f>(4, V3f(1.f))) : -1;
    for (int i = 0; i < count; ++i) {
        const V2f px{float(w.view.size.x) * w.dice.between(0.05f, 0.95f),
                     float(w.view.size.y) * w.dice.between(0.05f, 0.95f)};
        const float far = depth * w.dice.between(0.9f, 1.1f);
        const V3f at = w.view.at(px, far);
        nlohmann::json glow = glowing(nits, w.dice.colour());
        if (textured) glow["emissiveTexture"]["index"] = white;
        w.card(at, size_m / 2, w.material(glow));
        w.covers(at, 0.7f * disc_m / w.view.pixel_m(far) + 4);
    }
}

void add_glints(PlanWorld& w) {
    w.maybe_large(0.2f);
    const float depth = w.dice.between(1.5f, 3);
    if (w.dice.chance(0.25f))
        w.pinhole(w.dice.between(20, 40));
    else if (w.dice.chance(0.5f))
        w.thin_lens(30, w.dice.log_between(0.003f, 0.03f), 0.8f * depth);
    else
        static_cast<void>(set_fast_lens(w, 2));
    if (!w.large) w.even_wall(w.dice.log_between(0.02f, 0.5f));
    if (w.decoy()) w.soft_stage();
    const int count = w.large ? w.dice.whole(1, 2) : w.dice.whole(1, 8);
    const bool measured = w.dice.chance(0.5f);
    for (int i = 0; i < count; ++i) {
        const V2f px{float(w.view.size.x) * w.dice.between(0.05f, 0.95f),
                     float(w.view.size.y) * w.dice.between(0.1f, 0.9f)};
        const float radius_px = w.dice.log_between(1, 8);
        const float roughness = w.decoy() ? 0.8f : w.dice.log_between(0.05f, 0.3f);
        nlohmann::json metal = shiny_metal(w.dice.colour(), roughness);
        if (measured) metal = with_extra(metal, "metal", w.dice.pick(kMetals));
        const V3f at = w.view.at(px, depth);
        w.ball(at, radius_px * w.view.pixel_m(depth), w.material(metal));
        // Out of focus it is larger.
        const apps::CameraRequest& camera = w.scene.request.camera;
        w.covers(at, radius_px + (camera.lens_radius_m || camera.lens ? 12.f : 1.f));
    }
    const V3f from =
        V3f{w.dice.between(-1, 1), w.dice.between(0.3f, 1), w.dice.between(-0.2f, 1)}.normalized();
    const V3f at = V3f(0, 0, -depth) + from * 2.f;
    const int way = w.dice.whole(0, 2);
    const float strength = w.dice.log_between(1, 20);
    if (way == 0) return w.lamp(at, {}, 4 * strength);
    if (way == 1) return w.lamp(at, -from, strength);
    const float half = w.dice.log_between(0.001f, 0.01f);
    w.covers(at, 20);
    const V3f x = from.cross(V3f(0.1f, 0, 1)).normalized(), y = x.cross(from);
    w.quad(at - x * half - y * half, x * (2 * half), y * (2 * half),
           w.material(glowing(strength / (half * half))));
}

void add_spectra(PlanWorld& w) {
    w.maybe_large(0.2f);
    const float fov = w.dice.between(25, 40);
    if (w.dice.chance(0.7f))
        w.pinhole(fov);
    else
        w.thin_lens(fov, w.dice.log_between(0.002f, 0.03f), 4.f);
    if (w.dice.chance(0.6f)) return add_box(w);
    // Measured metals and coloured things under small lamps.
    constexpr float kDepth_m = 3;
    if (!w.large) w.even_wall(w.dice.log_between(0.02f, 1));
    const int count = w.large ? 2 : w.dice.whole(2, 6);
    for (int i = 0; i < count; ++i) {
        const V2f px{float(w.view.size.x) * w.dice.between(0.1f, 0.9f),
                     float(w.view.size.y) * w.dice.between(0.2f, 0.8f)};
        const float radius_px = w.dice.log_between(2, w.large ? 12 : 10);
        const V3f at = w.view.at(px, kDepth_m);
        w.ball(at, radius_px * w.view.pixel_m(kDepth_m),
               w.material(w.dice.chance(0.5f) ? measured_metal(w) : matt(w.dice.pick(kSaturated))));
        w.covers(at, radius_px + 14);
    }
    const float half = w.decoy() ? 0.5f : w.dice.log_between(0.01f, 0.2f);
    const float nits = 4 / (half * half);
    w.quad(V3f(-half, 2, -kDepth_m + 1.5f), {2 * half, 0, 0}, {0, half, -2 * half},
           w.material(w.decoy() ? glowing(nits) : spiky(w, nits)));
}

}  // namespace petzval::test
