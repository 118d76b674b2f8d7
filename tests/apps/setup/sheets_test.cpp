// SPDX-License-Identifier: Apache-2.0
// Surfaces whose back is a reversed copy, as files have them: each side is seen, as they stand.
#include <gtest/gtest.h>

#include "core/scene/motion.h"
#include "core/traversal/bvh.h"
#include "integrator/path/front_at_back.h"
#include "tests/support/load_tiny_gltf.h"

namespace petzval::apps {
namespace {

using Json = nlohmann::json;

/// A quad of four vertices that is bent by its skin, its morph target, or neither.
class SheetFile : public TinyGltf {
  public:
    explicit SheetFile(const std::string& by) : by_(by) {
        for (const double albedo : {0.5, 0.2})
            add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {albedo, 0, 0, 1}}}}});
        if (by != "skin") return;
        add_root({{"translation", {0.3, 0, 2}}});
        add_root({{"rotation", {0, 0.6, 0, 0.8}}});
        add("skins", {{"joints", {0, 1}}});
    }

    /// A primitive of vertices of its own.
    Json primitive(const std::vector<uint16_t>& indices, int material) {
        Json out = {{"attributes",
                     {{"POSITION", add_positions({-1, -1, 0, 1, -1, 0.5f, 1, 1, 0,  //
                                                  -1, 1, 0.3f})}}},
                    {"indices", add_accessor<uint16_t>("SCALAR", indices)},
                    {"material", material}};
        if (by_ == "skin") {
            out["attributes"]["JOINTS_0"] =
                add_accessor<uint8_t>("VEC4", {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0});
            out["attributes"]["WEIGHTS_0"] = add_accessor<float>(
                "VEC4", {1, 0, 0, 0, 0.3f, 0.7f, 0, 0, 0, 1, 0, 0, .5f, .5f, 0, 0});
        }
        if (by_ == "morph")
            out["targets"] = {
                {{"POSITION", add_positions({0, 0, 3, 0.1f, 0, 0, 0, 0, 1, 0, 0, 2})}}};
        return out;
    }
    int mesh(const std::vector<Json>& primitives) {
        Json out = {{"primitives", primitives}};
        if (by_ == "morph") out["weights"] = {0.7};
        return add("meshes", std::move(out));
    }
    void node(int mesh, const Json& more = Json::object()) {
        Json out = more;
        out["mesh"] = mesh;
        if (by_ == "skin") out["skin"] = 0;
        add_root(std::move(out));
    }

  private:
    std::string by_;
};

const std::vector<uint16_t> kThere = {0, 1, 2, 0, 2, 3}, kBack = {0, 2, 1, 0, 3, 2};

/// What rays see that come from both sides of every triangle to its middle, out of many that are to
/// see something: a front each time.
struct Seen {
    int rays = 0, fronts = 0;
};
Seen seen(const TinyGltf& file) {
    io::GltfFile loaded = load(file);
    Scene& scene = loaded.scene;
    finish_scene(scene);
    const Bvh bvh(scene, Traversal::Robust);
    Seen out;
    for (uint32_t i = 0; i < scene.instances.size(); ++i)
        for (uint32_t t = 0; t < scene.meshes[scene.instances[i].mesh].triangles.size(); ++t) {
            const auto corner = triangle_corners(scene, i, t, kMiddleOfShutter);
            const V3f middle = (corner[0] + corner[1] + corner[2]) / 3.f;
            const V3f across = unit((corner[1] - corner[0]).cross(corner[2] - corner[0]));
            const V3f along = unit(corner[1] - corner[0]);
            for (const float side : {-1.f, 1.f}) {
                const V3f from = middle + (across * side + along * 0.3f) * 0.2f;
                const Ray ray{from, unit(middle - from)};
                ++out.rays;
                const auto hit = bvh.intersect(ray);
                if (!hit) continue;
                const Surface s = make_surface(scene, ray.direction, *hit);
                out.fronts += s.front || integrator::front_at_back(scene, bvh, ray, s);
            }
        }
    return out;
}
void expect_fronts(const TinyGltf& file, int faces) {
    const Seen found = seen(file);
    EXPECT_EQ(found.rays, 2 * faces);
    EXPECT_EQ(found.fronts, found.rays);
}

class SheetOrder : public testing::TestWithParam<std::string> {};

TEST_P(SheetOrder, BothSidesAreSeenInOnePrimitive) {
    for (const auto& indices :
         {std::vector<uint16_t>{0, 1, 2, 0, 2, 3, 0, 2, 1, 0, 3, 2},     // the copy last
          std::vector<uint16_t>{0, 2, 1, 0, 3, 2, 0, 1, 2, 0, 2, 3},     // first
          std::vector<uint16_t>{3, 2, 0, 0, 1, 2, 1, 0, 2, 2, 3, 0}}) {  // in between
        SheetFile file(GetParam());
        file.node(file.mesh({file.primitive(indices, 0)}));
        expect_fronts(file, 4);
    }
}

TEST_P(SheetOrder, BothSidesAreSeenAcrossPrimitives) {
    for (const bool back_first : {false, true}) {
        SheetFile file(GetParam());
        file.node(file.mesh({file.primitive(back_first ? kBack : kThere, 0),
                             file.primitive(back_first ? kThere : kBack, 1)}));
        expect_fronts(file, 4);
    }
}

TEST_P(SheetOrder, BothSidesAreSeenAcrossNodes) {
    for (const Json& place : {Json::object(), Json{{"translation", {1e3, 0.1, -7}}},
                              Json{{"rotation", {0.6, 0, 0, 0.8}}, {"scale", {1, -2, 3}}}}) {
        SheetFile file(GetParam());
        file.node(file.mesh({file.primitive(kBack, 0)}), place);
        file.node(file.mesh({file.primitive(kThere, 1)}), place);
        expect_fronts(file, 4);
    }
}

TEST_P(SheetOrder, BothSidesAreSeenAtEachOfManyPlaces) {
    if (GetParam() == "skin") GTEST_SKIP() << "a skin stands where its joints are";
    SheetFile file(GetParam());
    const int mesh = file.mesh({file.primitive(kBack, 0), file.primitive(kThere, 1)});
    for (const float x : {0.f, 3.f, 7.f}) file.node(mesh, {{"translation", {x, 0, 0}}});
    expect_fronts(file, 12);
}

INSTANTIATE_TEST_SUITE_P(Sheets, SheetOrder, testing::Values("nothing", "skin", "morph"),
                         [](const auto& of) { return of.param; });

// Other poses of the same file lie apart.
TEST(Sheets, ThePoseCounts) {
    SheetFile file("morph");
    file.node(file.mesh({file.primitive(kBack, 0)}));
    Json still = file.primitive(kThere, 1);
    still.erase("targets");
    file.json["meshes"].push_back({{"primitives", {still}}});
    file.add_root({{"mesh", 1}});
    EXPECT_EQ(seen(file).fronts, seen(file).rays / 2);
    file.json["meshes"][0]["weights"] = {0};
    expect_fronts(file, 4);
}

}  // namespace
}  // namespace petzval::apps
