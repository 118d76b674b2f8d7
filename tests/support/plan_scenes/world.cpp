// SPDX-License-Identifier: Apache-2.0
#include "tests/support/plan_scenes/world.h"

#include "tests/support/tiny_png.h"

namespace petzval::test {
namespace {

using nlohmann::json;

json list(V3f v) {
    return {v.x, v.y, v.z};
}

void put(std::vector<float>& to, V3f v) {
    to.insert(to.end(), {v.x, v.y, v.z});
}

float radians(float deg) {
    return deg * kPi / 180;
}

}  // namespace

json matt(V3f colour) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {colour.x, colour.y, colour.z, 1}},
              {"metallicFactor", 0},
              {"roughnessFactor", 1}}},
            {"doubleSided", true},
            {"extensions", {{"KHR_materials_specular", {{"specularFactor", 0}}}}}};
}

json glowing(float nits, V3f colour) {
    json out = matt(V3f(0.f));
    out["emissiveFactor"] = list(colour);
    out["extensions"]["KHR_materials_emissive_strength"] = {{"emissiveStrength", nits}};
    return out;
}

json random_glow(PlanDice& dice, float low, float high) {
    const float nits = dice.log_between(low, high);
    return glowing(nits, dice.colour());
}

json glass(float ior, float dispersion) {
    json out = {
        {"pbrMetallicRoughness",
         {{"baseColorFactor", {1, 1, 1, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0}}}};
    out["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
    out["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 0.1}};
    out["extensions"]["KHR_materials_ior"] = {{"ior", ior}};
    if (dispersion > 0)
        out["extensions"]["KHR_materials_dispersion"] = {{"dispersion", dispersion}};
    return out;
}

json shiny_metal(V3f colour, float roughness) {
    return {{"pbrMetallicRoughness",
             {{"baseColorFactor", {colour.x, colour.y, colour.z, 1}},
              {"metallicFactor", 1},
              {"roughnessFactor", roughness}}}};
}

json with_extra(json material, const char* key, const std::string& name) {
    material["extras"]["petzval"][key] = name;
    return material;
}

PlanWorld::PlanWorld(uint32_t index, const char* kind) : dice(hash32(0x9a7f00d, index)) {
    scene.kind = kind;
    scene.tolerance = index / kPlanSceneKinds % 2 ? 0.05 : 0.01;
    scene.decoy = dice.chance(0.2f);
    file_.json["extensionsUsed"] = {
        "KHR_lights_punctual", "KHR_materials_dispersion", "KHR_materials_emissive_strength",
        "KHR_materials_ior",   "KHR_materials_specular",   "KHR_materials_transmission",
        "KHR_materials_unlit", "KHR_materials_volume"};
    scene.request.background = Rgb(0.f);
}

void PlanWorld::maybe_large(float share, int narrowest, int widest) {
    large = dice.chance(share) && !decoy();
    if (!large) return;
    const int width = 16 * dice.whole(narrowest / 16, widest / 16);
    view.size = {width, width * 9 / 16};
}

void PlanWorld::look() {
    scene.request.size = view.size;
    scene.request.camera.look_at = {V3f(0.f), V3f(0, 0, -1)};
}

void PlanWorld::pinhole(float fov_deg) {
    view.tan_up = std::tan(radians(fov_deg) / 2);
    scene.request.camera.fov_deg = fov_deg;
    look();
}

void PlanWorld::thin_lens(float fov_deg, float radius_m, float focus_m) {
    pinhole(fov_deg);
    scene.request.camera.lens_radius_m = radius_m;
    scene.request.camera.focus = apps::FocusDistance{focus_m};
}

void PlanWorld::real_lens(const std::string& name, float focal_mm, float focus_m) {
    constexpr float kWidth_mm = 36;
    // To focus on what is near, the film stands farther behind.
    const float film_mm = focal_mm * focus_m / (focus_m - focal_mm / 1000);
    view.tan_up = kWidth_mm / 2 / film_mm * float(view.size.y) / float(view.size.x);
    scene.request.camera.lens = name;
    scene.request.camera.sensor_mm = V2f(kWidth_mm, 24);
    scene.request.camera.focus = apps::FocusDistance{focus_m};
    look();
}

int PlanWorld::material(json value) {
    return file_.add("materials", std::move(value));
}

void PlanWorld::mesh(const std::vector<float>& positions, const std::vector<float>& normals,
                     const std::vector<float>& uv, const std::vector<uint32_t>& indices,
                     int material) {
    json primitive = {{"material", material}};
    primitive["attributes"]["POSITION"] = file_.add_positions(positions);
    if (!normals.empty()) primitive["attributes"]["NORMAL"] = file_.add_accessor("VEC3", normals);
    if (!uv.empty()) primitive["attributes"]["TEXCOORD_0"] = file_.add_accessor("VEC2", uv);
    primitive["indices"] = file_.add_accessor("SCALAR", indices);
    file_.add_root({{"mesh", file_.add_mesh(primitive)}});
}

void PlanWorld::quad(V3f corner, V3f a, V3f b, int material) {
    std::vector<float> positions;
    for (const V3f& p : {corner, corner + a, corner + a + b, corner + b}) put(positions, p);
    mesh(positions, {}, {0, 1, 1, 1, 1, 0, 0, 0}, {0, 1, 2, 0, 2, 3}, material);
}

void PlanWorld::ball(V3f middle, float radius, int material, int rows) {
    std::vector<float> positions, normals;
    std::vector<uint32_t> indices;
    const int columns = 2 * rows;
    for (int i = 0; i <= rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            const float theta = kPi * float(i) / float(rows), phi = kPi * float(j) / float(rows);
            const V3f n(std::sin(theta) * std::cos(phi), std::cos(theta),
                        -std::sin(theta) * std::sin(phi));
            put(positions, middle + n * radius);
            put(normals, n);
        }
    }
    const auto at = [&](int i, int j) { return uint32_t(i * columns + j % columns); };
    for (int i = 0; i < rows; ++i) {
        for (int j = 0; j < columns; ++j) {
            if (i > 0) indices.insert(indices.end(), {at(i, j), at(i + 1, j), at(i, j + 1)});
            if (i + 1 < rows)
                indices.insert(indices.end(), {at(i, j + 1), at(i + 1, j), at(i + 1, j + 1)});
        }
    }
    mesh(positions, normals, {}, indices, material);
}

void PlanWorld::body(const std::vector<V3f>& corners, const std::vector<std::vector<int>>& faces,
                     int material) {
    V3f middle(0.f);
    for (const V3f& p : corners) middle += p / float(corners.size());
    std::vector<float> positions;
    std::vector<uint32_t> indices;
    for (const std::vector<int>& face : faces) {
        const auto corner = [&](size_t i) { return corners[size_t(face[i])]; };
        const V3f normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
        const bool outward = normal.dot(corner(0) - middle) > 0;
        const auto first = uint32_t(positions.size() / 3);
        for (size_t i = 0; i < face.size(); ++i) put(positions, corner(i));
        for (uint32_t i = 1; i + 1 < face.size(); ++i) {
            const uint32_t b = first + i, c = b + 1;
            indices.insert(indices.end(), {first, outward ? b : c, outward ? c : b});
        }
    }
    mesh(positions, {}, {}, indices, material);
}

int PlanWorld::texture(uint32_t width, uint32_t height, const std::vector<V3f>& colours) {
    std::vector<uint8_t> rgba;
    for (const V3f& c : colours)
        for (const float v : {c.x, c.y, c.z, 1.f}) rgba.push_back(uint8_t(std::lround(255 * v)));
    const int image = file_.add_image(tiny_png(width, height, rgba));
    constexpr int kNearest = 9728;
    const int sampler = file_.add("samplers", {{"magFilter", kNearest}, {"minFilter", kNearest}});
    return file_.add("textures", {{"source", image}, {"sampler", sampler}});
}

void PlanWorld::lamp(V3f at, V3f towards, float intensity) {
    auto& lights = file_.json["extensions"]["KHR_lights_punctual"]["lights"];
    const bool sun = towards.length() > 0;
    const size_t index = lights.is_array() ? lights.size() : 0;
    lights.push_back({{"type", sun ? "directional" : "point"}, {"intensity", intensity}});
    json node = {{"translation", list(at)}};
    node["extensions"]["KHR_lights_punctual"] = {{"light", index}};
    if (sun) {  // half of the way from -z to the direction, doubled: a quaternion
        const V3f to = towards.normalized(), from(0, 0, -1);
        const V3f axis = from.cross(to);
        const float w = 1 + from.dot(to), length = std::sqrt(axis.length2() + w * w);
        node["rotation"] = {axis.x / length, axis.y / length, axis.z / length, w / length};
    }
    file_.add_root(node);
}

void PlanWorld::even_wall(float nits) {
    constexpr float kDistance_m = 60, kHalf_m = 300;
    card({0, 0, -kDistance_m}, kHalf_m, material(glowing(nits)));
}

void PlanWorld::soft_stage() {
    even_wall(0.3f);
    for (int i = 0; i < 3; ++i) {
        const V3f at = view.at({float(view.size.x) * (0.2f + 0.3f * float(i)),
                                float(view.size.y) * dice.between(0.3f, 0.7f)},
                               4.f);
        const V3f colour{dice.between(0.3f, 0.8f), dice.between(0.3f, 0.8f), 0.6f};
        ball(at, 0.2f * float(view.size.y) * view.pixel_m(4), material(matt(colour)), 32);
    }
    quad({-3, 4, 2}, {6, 0, 0}, {0, 2, -2}, material(glowing(2)));
}

void PlanWorld::covers(V3f at, float radius_px) {
    if (!(at.z < 0)) return;  // behind the camera
    const V2f middle = view.pixel_of(at);
    constexpr float kFilter_px = 3;  // an edge's light reaches so far
    const float r = radius_px + kFilter_px;
    const auto within = [](float v, int most) {
        return std::clamp(static_cast<int>(std::floor(v)), 0, most);
    };
    const Rect rect{within(middle.x - r, view.size.x), within(middle.y - r, view.size.y),
                    within(middle.x + r + 1, view.size.x), within(middle.y + r + 1, view.size.y)};
    if (rect.width() > 0 && rect.height() > 0) scene.matters.push_back(rect);
}

PlanScene PlanWorld::finish() {
    if (!large) scene.matters = {{0, 0, view.size.x, view.size.y}};
    scene.gltf = file_.text();
    return std::move(scene);
}

}  // namespace petzval::test
