// SPDX-License-Identifier: Apache-2.0
// Scenes of patterns as fine as pixels: barcodes, textures, and dots near the rim.
#include "tests/support/plan_scenes/kinds.h"

namespace petzval::test {
namespace {

struct Lens {
    const char* name;
    float focal_mm, nearest_m;
};

constexpr std::array<Lens, 6> kLateral{{{"petzval-portrait-100mm-f3.6", 100, 2},
                                        {"tessar-100mm-f2.8", 100, 2},
                                        {"double-gauss-100mm-f2", 100, 2},
                                        {"takumar-50mm-f1.2", 50, 1},
                                        {"biotar-58mm-f1.4", 58, 1},
                                        {"angenieux-50mm-f1.1", 50, 1}}};
constexpr std::array<Lens, 5> kWide{{{"minolta-fisheye-16mm-f2.8", 16, 1},
                                     {"canon-14mm-f2.8-asph", 14.2f, 1},
                                     {"nikkor-retrofocus-28mm-f2.8", 28, 1},
                                     {"biotar-58mm-f1.4", 58, 1.5f},
                                     {"petzval-portrait-100mm-f3.6", 100, 2}}};

/// Most that distortion moves a thing near the rim, as a share of the picture's width.
constexpr float kDistortion = 0.03f;

/// A lens of one glass, on a film 36 mm wide.
void singlet(PlanWorld& w, float focal_mm, float fstop, float focus_m) {
    const bool flint = w.dice.chance(0.5f);
    w.real_lens(flint ? "singlet:schott:N-SF11" : "singlet:schott:N-BK7", focal_mm, focus_m);
    w.scene.request.camera.focal_length_mm = focal_mm;
    w.scene.request.camera.fstop = fstop;
}

/// Where a lens shows what lies so far from the axis, given as a share of half the picture's width:
/// its distortion moves things near the rim, a fisheye's most of all.
V3f near_rim(const PlanWorld& w, float turn, float share, float depth, bool fisheye) {
    const float radius = share * 0.5f * float(w.view.size.x);
    const V2f middle(0.5f * float(w.view.size.x), 0.5f * float(w.view.size.y));
    V2f off(std::cos(turn) * radius, std::sin(turn) * radius);
    off.y = std::clamp(off.y, -0.95f * middle.y, 0.95f * middle.y);
    if (!fisheye) return w.view.at(middle + off, depth);
    // Equisolid: a radius of 2 f sin(angle / 2).
    const float on_film = off.length() * w.view.pixel_m(1);
    const float angle = 2 * std::asin(std::min(on_film / 2, 0.68f));
    const V2f side = off.normalized() * (std::sin(angle) * depth);
    return {side.x, -side.y, -std::cos(angle) * depth};
}

}  // namespace

void add_barcode(PlanWorld& w) {
    w.maybe_large(0.5f, 400);
    const Lens& lens = w.dice.pick(kLateral);
    const float depth = lens.nearest_m * w.dice.between(1, 2);
    w.real_lens(lens.name, lens.focal_mm, depth);
    if (w.dice.chance(0.2f)) w.scene.request.camera.fstop = w.dice.between(4, 8);
    if (w.decoy()) return w.soft_stage();
    if (!w.large && w.dice.chance(0.5f)) w.even_wall(w.dice.log_between(0.02f, 0.5f));
    const V2f size(w.view.size);
    const float side_px = w.large ? w.dice.between(16, 48) : w.dice.between(8, 16);
    const V2f corner{w.dice.sign(), w.dice.sign()};
    const V2f px{
        0.5f * size.x + corner.x * (0.5f * size.x * w.dice.between(0.75f, 0.97f) - 0.6f * side_px),
        0.5f * size.y + corner.y * (0.5f * size.y * w.dice.between(0.5f, 0.9f) - 0.6f * side_px)};
    const V3f middle = w.view.at(px, depth);
    const float unit = w.view.pixel_m(depth), half = side_px / 2 * unit;
    const float turn = w.dice.between(0, kPi);
    const V3f across(std::cos(turn), std::sin(turn), 0), along(-across.y, across.x, 0);
    const int bar = w.material(random_glow(w.dice, 0.5f, 20));
    const float thinnest_px = w.dice.log_between(0.2f, 1.5f);
    for (float at = -half; at < half;) {
        const float width = unit * thinnest_px * float(w.dice.whole(1, 3));
        w.quad(middle + across * at - along * half, across * width, along * (2 * half), bar);
        at += width + unit * thinnest_px * float(w.dice.whole(1, 3));
    }
    w.covers(middle, 0.7f * side_px + 0.015f * size.x + 1);
}

void add_textures(PlanWorld& w) {
    w.maybe_large(0.25f, 320, 400);
    const float depth = w.dice.between(2, 3);
    const float focus = depth * (w.dice.chance(0.5f) ? 1.f : w.dice.between(0.9f, 1.15f));
    const int camera = w.dice.whole(0, 3);
    if (camera == 0) w.pinhole(w.dice.between(20, 40));
    if (camera == 1) w.thin_lens(30, w.dice.log_between(0.0005f, 0.02f), focus);
    if (camera > 1) {
        const Lens& lens = w.dice.pick(kLateral);
        w.real_lens(lens.name, lens.focal_mm, focus);
    }
    const V2f size(w.view.size);
    const bool whole = !w.large && w.dice.chance(0.6f);
    const float wide_px = whole ? 1.1f * size.x : w.dice.between(6, 24);
    const float high_px = whole ? 1.1f * size.y : wide_px;
    const float texel_px = w.decoy() ? 16 : w.dice.log_between(0.5f, 4);
    const auto texels = [&](float px) { return std::clamp(int(px / texel_px), 2, 125); };
    const int columns = texels(wide_px), rows = texels(high_px);
    const bool grey = w.dice.chance(0.5f);
    const float share = w.dice.between(0.1f, 0.9f);  // of texels that are dark
    std::vector<V3f> colours;
    for (int i = 0; i < columns * rows; ++i)
        colours.push_back(
            w.dice.chance(share) ? V3f(0.f)
            : grey               ? V3f(1.f)
                   : V3f{w.dice.between(0, 1), w.dice.between(0, 1), w.dice.between(0, 1)});
    const int texture = w.texture(uint32_t(columns), uint32_t(rows), colours);
    const int way = w.dice.whole(0, 2);
    nlohmann::json material = matt(V3f(1.f));
    if (way == 1) material = glowing(w.dice.log_between(0.5f, 20));
    if (way == 1)
        material["emissiveTexture"] = {{"index", texture}};
    else
        material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", texture}};
    if (way == 0) material["extensions"]["KHR_materials_unlit"] = nlohmann::json::object();
    if (way == 2) w.quad({-2, 3, 0}, {4, 0, 0}, {0, 1, -1}, w.material(glowing(3)));
    const V2f px =
        whole ? 0.5f * size
              : V2f{size.x * w.dice.between(0.2f, 0.8f), size.y * w.dice.between(0.3f, 0.7f)};
    const V3f middle = w.view.at(px, depth);
    const float unit = w.view.pixel_m(depth);
    w.quad(middle - V3f(wide_px, high_px, 0) * (unit / 2), {wide_px * unit, 0, 0},
           {0, high_px * unit, 0}, w.material(material));
    if (!w.large && !whole) w.even_wall(w.dice.log_between(0.02f, 0.5f));
    w.covers(middle, 0.75f * std::max(wide_px, high_px) + 0.02f * size.x + 8);
}

void add_rim(PlanWorld& w) {
    w.maybe_large(0.4f, 320, 352);
    bool fisheye = false;
    float depth = 2;
    if (w.dice.chance(0.25f)) {
        singlet(w, 60, w.dice.between(4, 11), depth);
    } else {
        const size_t first = w.large ? 1 : 0;  // a fisheye's distortion would need wide margins
        const Lens& lens = kWide[size_t(w.dice.whole(int(first), int(kWide.size()) - 1))];
        fisheye = &lens == kWide.data();
        depth = lens.nearest_m * w.dice.between(1, 2);
        w.real_lens(lens.name, lens.focal_mm, depth);
    }
    if (w.decoy()) return w.soft_stage();
    if (!w.large && w.dice.chance(0.4f)) w.even_wall(w.dice.log_between(0.01f, 0.1f));
    const int count = w.large ? w.dice.whole(3, 8) : w.dice.whole(3, 20);
    for (int i = 0; i < count; ++i) {
        const float turn = w.dice.between(0, 2 * kPi), share = w.dice.between(0.7f, 0.97f);
        const V3f at = near_rim(w, turn, share, depth, fisheye);
        const float half_px = w.dice.log_between(0.15f, w.large ? 3.f : 1.5f);
        w.card(at, half_px * w.view.pixel_m(-at.z), w.material(random_glow(w.dice, 0.5f, 30)));
        w.covers(at, half_px + kDistortion * float(w.view.size.x) + 3);
    }
}

}  // namespace petzval::test
