// SPDX-License-Identifier: Apache-2.0
// BLEND and MASK of files that pose, place, move and paint their cards in every way, against what
// the test finds by its own account: where each card is, what it covers there, and what is seen.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <optional>

#include "core/scene/coverage.h"
#include "integrator/path/path.h"
#include "tests/support/moving_gltf.h"
#include "tests/support/scenes.h"
#include "tests/support/tiny_png.h"

namespace petzval::apps {
namespace {

using nlohmann::json;

constexpr double kAt = 0.5, kOpen = 0.5;  // when the shutter is half open, and how long, in s
constexpr double kSky = 3, kShown = 0.6, kCutoff = 0.5;
constexpr int kTexels = 8;

/// Two cards, one before the other, which are not square and not in parallel.
const std::vector<V3d> kCards = {{-1, -1, 0},   {1, -1, 0.2}, {1, 1, 0},    {-1, 1, 0.1},
                                 {-1, -1, 0.6}, {1, -1, 0.8}, {1, 1, 0.95}, {-1, 1, 0.7}};
const std::vector<uint16_t> kTriangles = {0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7};
const std::vector<V2d> kUv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {1, 0}, {1, 1}, {0.2, 1}, {0, 0}};

template <class T>
std::vector<float> floats(const std::vector<T>& values) {
    std::vector<float> out;
    for (const T& v : values)
        for (unsigned i = 0; i < T::dimensions(); ++i)
            out.push_back(static_cast<float>(v[static_cast<int>(i)]));
    return out;
}

std::vector<std::vector<double>> texels() {
    std::vector<std::vector<double>> out(kTexels, std::vector<double>(kTexels));
    for (uint32_t y = 0; y < kTexels; ++y)
        for (uint32_t x = 0; x < kTexels; ++x)  // none, or enough for its cards not to be drawn
            out[y][x] = hash32(x, y) % 3 ? 0.3 + 0.7 * to_unit_float(hash32(y, x)) : 0;
    return out;
}

/// Bilinear, repeated.
double texture_at(const V2d& uv) {
    static const auto table = texels();
    const double x = uv.x * kTexels - 0.5, y = uv.y * kTexels - 0.5;
    const auto at = [&](double i, double j) {
        const auto wrapped = [](double k) {
            return static_cast<size_t>(std::lround(k - kTexels * std::floor(k / kTexels)));
        };
        return std::round(255 * table[wrapped(j)][wrapped(i)]) / 255;
    };
    const double i = std::floor(x), j = std::floor(y), a = x - i, b = y - j;
    return (1 - b) * ((1 - a) * at(i, j) + a * at(i + 1, j)) +
           b * ((1 - a) * at(i, j + 1) + a * at(i + 1, j + 1));
}

/// What paints the cards: the material and attributes of a file, and the alpha of a point by the
/// coordinates and the vertices' own alpha there.
struct Paint {
    const char* name;
    double factor;
    bool texture, transform, second_set, colours;

    [[nodiscard]] V2d moved(const V2d& uv) const {  // KHR_texture_transform: scale, turn, offset
        if (!transform) return uv;
        const double s = std::sin(0.7), c = std::cos(0.7), x = 1.5 * uv.x, y = -0.8 * uv.y;
        return {c * x + s * y + 0.3, -s * x + c * y + 0.6};
    }
    [[nodiscard]] double alpha(const V2d& uv, double of_vertices) const {
        return factor * (texture ? texture_at(moved(uv)) : 1) * (colours ? of_vertices : 1);
    }
    void add_to(TinyGltf& file, json& primitive, bool mask) const {
        json pbr = {{"baseColorFactor", {kShown, kShown, kShown, factor}}};
        std::vector<float> unused(2 * kUv.size(), 0.25f), uv = floats(kUv);
        const int first = file.add_accessor("VEC2", second_set ? unused : uv),
                  second = file.add_accessor("VEC2", second_set ? uv : unused);
        if (texture) {
            std::vector<uint8_t> rgba;
            for (const auto& row : texels())
                for (const double alpha : row)
                    rgba.insert(rgba.end(), {255, 255, 255, uint8_t(std::lround(255 * alpha))});
            file.add("textures", {{"source", file.add_image(tiny_png(kTexels, kTexels, rgba))}});
            pbr["baseColorTexture"] = {{"index", 0}, {"texCoord", second_set ? 1 : 0}};
            if (transform)
                pbr["baseColorTexture"]["extensions"]["KHR_texture_transform"] = {
                    {"offset", {0.3, 0.6}}, {"rotation", 0.7}, {"scale", {1.5, -0.8}}};
            primitive["attributes"]["TEXCOORD_0"] = first;
            primitive["attributes"]["TEXCOORD_1"] = second;
        }
        if (colours) {
            std::vector<float> rgba;
            for (size_t i = 0; i < kCards.size(); ++i)
                rgba.insert(rgba.end(), {1, 1, 1, float(of_vertex(i))});
            primitive["attributes"]["COLOR_0"] = file.add_accessor("VEC4", rgba);
        }
        json material = {{"pbrMetallicRoughness", pbr},
                         {"alphaMode", mask ? "MASK" : "BLEND"},
                         {"doubleSided", true},
                         {"extensions", {{"KHR_materials_unlit", json::object()}}}};
        if (mask) material["alphaCutoff"] = kCutoff;
        primitive["material"] = file.add("materials", material);
    }
    static double of_vertex(size_t i) { return 0.45 + 0.5 * double(i % 3) / 2; }
};
const Paint kPaints[] = {{"factor", 0.55, false, false, false, false},
                         {"texture", 1, true, false, false, false},
                         {"transformed texture", 1, true, true, false, false},
                         {"texture of the second set", 0.9, true, true, true, false},
                         {"colours of vertices", 1, false, false, false, true},
                         {"all", 1, true, true, true, true}};

/// Corners of all cards in the world at a time of the shutter, card by card.
using Corners = std::function<std::vector<V3d>(double time)>;

/// A way to put the cards into the scene: what it adds to a file whose one primitive is given.
struct Posing {
    const char* name;
    Corners (*add)(TinyGltf&, json primitive);
};

std::vector<V3d> placed(const M44d& m) {
    std::vector<V3d> out;
    for (const V3d& p : kCards) out.push_back(p * m);
    return out;
}
/// Stretched, turned about an axis, moved.
M44d matrix(const V3d& at, double degrees = 0, const V3d& axis = {0, 0, 1},
            const V3d& scale = V3d(1.)) {
    M44d stretch, turn;
    stretch.setScale(scale);
    turn.setAxisAngle(axis, degrees * M_PI / 180);
    M44d out = stretch * turn;
    for (int k = 0; k < 3; ++k) out[3][k] = at[k];
    return out;
}
double second_of(double time) {
    return kAt + (time - 0.5) * kOpen;
}

Corners plainly(TinyGltf& file, json primitive) {
    file.add_root({{"mesh", file.add_mesh(std::move(primitive))}});
    return [](double) { return kCards; };
}

Corners mirrored(TinyGltf& file, json primitive) {
    const V3d axis = V3d(1, 2, -0.5).normalized();
    file.add_root({{"mesh", file.add_mesh(std::move(primitive))},
                   {"translation", {0.2, -0.1, 0.3}},
                   {"rotation", test::quaternion(axis, 25)},
                   {"scale", {-1.2, 0.9, 0.8}}});
    const M44d m = matrix({0.2, -0.1, 0.3}, 25, axis, {-1.2, 0.9, 0.8});
    return [m](double) { return placed(m); };
}

/// Skinned to two joints, of which the second moves by as much a second.
Corners skinned(TinyGltf& file, json primitive, const V3d& speed) {
    std::vector<uint8_t> joints;
    std::vector<float> weights;
    const auto share = [](size_t i) { return double(i % 4) / 4; };
    for (size_t i = 0; i < kCards.size(); ++i) {
        joints.insert(joints.end(), {0, 1, 0, 0});
        weights.insert(weights.end(), {float(1 - share(i)), float(share(i)), 0, 0});
    }
    primitive["attributes"]["JOINTS_0"] = file.add_accessor("VEC4", joints);
    primitive["attributes"]["WEIGHTS_0"] = file.add_accessor("VEC4", weights);
    const int mesh = file.add_mesh(std::move(primitive));
    file.add_root({{"translation", {0.1, 0.2, -0.2}}});
    const int second = file.add_root(
        {{"translation", {0.2, 0, 0.1}}, {"rotation", test::quaternion({0, 0, 1}, 20)}});
    file.add("skins", {{"joints", {0, 1}}});
    file.add_root({{"mesh", mesh}, {"skin", 0}});
    if (speed.length() > 0)
        test::animate(file, second, "translation", {0, 1},
                      floats(std::vector{V3d(.2, 0, .1), V3d(.2, 0, .1) + speed}));
    return [=](double time) {
        const auto a = placed(matrix({0.1, 0.2, -0.2})),
                   b = placed(matrix(V3d(.2, 0, .1) + speed * second_of(time), 20));
        std::vector<V3d> out;
        for (size_t i = 0; i < a.size(); ++i)
            out.push_back(a[i] * (1 - share(i)) + b[i] * share(i));
        return out;
    };
}
Corners skinned_still(TinyGltf& file, json primitive) {
    return skinned(file, std::move(primitive), V3d(0.));
}
Corners skinned_moving(TinyGltf& file, json primitive) {
    return skinned(file, std::move(primitive), {0.6, -0.4, 0.3});
}

/// With a morph target of which 0.7 is shown, or what grows from 0.2 by as much a second.
Corners morphed(TinyGltf& file, json primitive, double speed) {
    std::vector<V3d> by;
    for (size_t i = 0; i < kCards.size(); ++i)
        by.emplace_back(0.4 * double(i % 3), -0.3 * double(i % 2), 0.2 * double(i % 4));
    primitive["targets"] = {{{"POSITION", file.add_positions(floats(by))}}};
    const int mesh = file.add_mesh(std::move(primitive));
    file.json["meshes"][size_t(mesh)]["weights"] = {0.7};
    const int node = file.add_root({{"mesh", mesh}});
    if (speed > 0) test::animate(file, node, "weights", {0, 1}, {0.2f, float(0.2 + speed)});
    return [=](double time) {
        const double weight = speed > 0 ? 0.2 + speed * second_of(time) : 0.7;
        std::vector<V3d> out = kCards;
        for (size_t i = 0; i < out.size(); ++i) out[i] += by[i] * weight;
        return out;
    };
}
Corners morphed_still(TinyGltf& file, json primitive) {
    return morphed(file, std::move(primitive), 0);
}
Corners morphed_moving(TinyGltf& file, json primitive) {
    return morphed(file, std::move(primitive), 0.9);
}

/// Of EXT_mesh_gpu_instancing, one of them mirrored, in a node that moves by as much a second.
Corners instanced(TinyGltf& file, json primitive, const V3d& speed) {
    const std::vector<V3d> at = {{0, 0, 0}, {0.5, 0.2, -0.5}, {-0.3, 0.4, 0.9}},
                           scales = {{1, 1, 1}, {-0.8, 1.1, 0.3}, {0.7, 0.7, 0.7}};
    const int mesh = file.add_mesh(std::move(primitive));
    const int t = file.add_accessor("VEC3", floats(at)),
              s = file.add_accessor("VEC3", floats(scales));
    const int node = file.add_root(
        {{"mesh", mesh},
         {"extensions",
          {{"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", t}, {"SCALE", s}}}}}}}});
    if (speed.length() > 0)
        test::animate(file, node, "translation", {0, 1}, floats(std::vector{V3d(0.), speed}));
    return [=](double time) {
        std::vector<V3d> out;
        for (size_t i = 0; i < at.size(); ++i)
            for (const V3d& p : placed(matrix(at[i], 0, {0, 0, 1}, scales[i])))
                out.push_back(p + speed * second_of(time));
        return out;
    };
}
Corners instanced_still(TinyGltf& file, json primitive) {
    return instanced(file, std::move(primitive), V3d(0.));
}
Corners instanced_moving(TinyGltf& file, json primitive) {
    return instanced(file, std::move(primitive), {0.8, 0.3, -0.4});
}

Corners node_moving(TinyGltf& file, json primitive) {
    const int node =
        file.add_root({{"mesh", file.add_mesh(std::move(primitive))}, {"scale", {1.1, -0.9, 1.3}}});
    test::animate(file, node, "translation", {0, 1}, {0.4f, 0, 0, -0.4f, 0.3f, 0.5f});
    return [](double time) {
        const double s = second_of(time);
        return placed(matrix({0.4 - 0.8 * s, 0.3 * s, 0.5 * s}, 0, {0, 0, 1}, {1.1, -0.9, 1.3}));
    };
}

const Posing kPosings[] = {{"plain", plainly},
                           {"mirrored", mirrored},
                           {"skin", skinned_still},
                           {"morph", morphed_still},
                           {"instances", instanced_still},
                           {"moving node", node_moving},
                           {"moving skin", skinned_moving},
                           {"moving morph", morphed_moving},
                           {"moving instances", instanced_moving}};

/// What a ray finds: the alpha of each card that it meets, by distance. Nothing where it passes
/// within rounding of an edge, or of where a mask ends.
std::optional<std::vector<double>> alphas_on(const Ray& ray, const std::vector<V3d>& corners,
                                             const Paint& paint, bool mask) {
    std::vector<std::pair<double, double>> met;
    const V3d o(ray.origin), d(ray.direction);
    for (size_t first = 0; first < corners.size(); first += kCards.size())
        for (size_t k = 0; k < kTriangles.size(); k += 3) {
            const size_t c[] = {kTriangles[k], kTriangles[k + 1], kTriangles[k + 2]};
            const V3d &p = corners[first + c[0]], e = corners[first + c[1]] - p,
                      f = corners[first + c[2]] - p, n = e.cross(f);
            const double t = (p - o).dot(n) / d.dot(n);
            const V3d at = o + d * t - p;
            const double b1 = at.cross(f).dot(n) / n.length2(),
                         b2 = e.cross(at).dot(n) / n.length2();
            const double inside = std::min({b1, b2, 1 - b1 - b2});
            if (std::fabs(inside) < 1e-3) return std::nullopt;
            if (inside < 0 || t <= 0) continue;
            const auto mixed = [&](const auto& of) {
                return of(c[0]) * (1 - b1 - b2) + of(c[1]) * b1 + of(c[2]) * b2;
            };
            const double alpha =
                paint.alpha(mixed([](size_t i) { return kUv[i]; }), mixed(Paint::of_vertex));
            if (mask && std::fabs(alpha - kCutoff) < 1e-3) return std::nullopt;
            met.emplace_back(t, mask ? double(alpha >= kCutoff) : alpha);
        }
    std::sort(met.begin(), met.end());
    std::vector<double> out;
    for (const auto& [t, alpha] : met) out.push_back(alpha);
    return out;
}

Ray random_ray(uint32_t i, float time) {
    const auto draw = [&](uint32_t k) { return to_unit_float(hash32(i, k)); };
    Ray ray;
    ray.origin = V3f(3 * draw(0) - 1.5f, 3 * draw(1) - 1.5f, i % 2 ? 5 : -5);
    ray.direction = unit(V3f(1.6f * draw(2) - 0.8f, 1.6f * draw(3) - 0.8f, 0.5f) - ray.origin);
    ray.time = time;
    ray.alpha_seed = hash32(i, 5);
    return ray;
}

void expect_as_computed(const Posing& posing, const Paint& paint, bool mask) {
    SCOPED_TRACE(std::string(mask ? "MASK, " : "BLEND, ") + posing.name + ", " + paint.name);
    TinyGltf file;
    file.json["extensionsUsed"] = {"KHR_texture_transform", "KHR_materials_unlit",
                                   "EXT_mesh_gpu_instancing"};
    json primitive = {{"attributes", {{"POSITION", file.add_positions(floats(kCards))}}},
                      {"indices", file.add_accessor("SCALAR", kTriangles)}};
    paint.add_to(file, primitive, mask);
    const Corners corners = posing.add(file, std::move(primitive));
    test::World world;
    world.scene = test::SavedGltf(file).at(kAt, kOpen).scene;
    world.scene.sky = Sky::uniform(Rgb(float(kSky)));
    world.finish();
    EXPECT_EQ(has_motion(world.scene), std::string(posing.name).starts_with("moving"));
    const integrator::PathTracer tracer(world.scene, *world.bvh, *world.lights,
                                        integrator::PathOptions());
    integrator::PathStats stats;

    int rays = 0, partial = 0;
    double worst_left = 0, worst_seen = 0;
    for (uint32_t i = 0; i < 400; ++i) {
        const float time = to_unit_float(hash32(i, 9));
        const Ray ray = random_ray(i, time);
        const auto alphas = alphas_on(ray, corners(double(time)), paint, mask);
        // More than are weighed, or so faint that a path may miss them, are met by chance.
        if (!alphas || alphas->size() > 8) continue;
        double left = 1, seen = 0;
        bool drawn = false;
        for (const double alpha : *alphas) {
            seen += left * alpha * kShown;
            left *= 1 - alpha;
            drawn |= alpha > 0 && alpha < double{kLeastMetCoverage} + 1e-3;
        }
        ++rays;
        partial += mask ? !alphas->empty() && left > 0 : left > 0 && left < 1;
        worst_left = std::max(worst_left, std::fabs(double{world.bvh->passage(ray).left} - left));
        if (drawn) continue;
        FilmSample out;
        const Sampler sampler(SamplerKind::Owen, 1, {0, 0, i});
        const f4 light = tracer.radiance({ray}, Bands::rgb(), sampler, out, stats);
        worst_seen = std::max(worst_seen, std::fabs(double{light[0]} - seen - left * kSky));
    }
    EXPECT_GT(rays, 300);
    if (!mask || paint.texture) EXPECT_GT(partial, 60);
    EXPECT_LT(worst_left, 1e-3);
    EXPECT_LT(worst_seen, 3e-3);
}

TEST(Coverage, OfBlendIsThatOfEachPoseAndPaint) {
    for (const Posing& posing : kPosings)
        for (const Paint& paint : kPaints) expect_as_computed(posing, paint, false);
}

TEST(Coverage, OfMaskIsThatOfEachPoseAndPaint) {
    for (const Posing& posing : kPosings)
        for (const Paint& paint : kPaints) expect_as_computed(posing, paint, true);
}

}  // namespace
}  // namespace petzval::apps
