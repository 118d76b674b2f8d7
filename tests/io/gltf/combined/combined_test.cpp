// SPDX-License-Identifier: Apache-2.0
// Files that combine what meshes may have, corner by corner: a mesh posed at rest is the mesh that
// is not posed, and any other pose is that of the reference.
#include <gtest/gtest.h>

#include "tests/support/combined/combined_gltf.h"
#include "tests/support/combined/corners.h"

namespace petzval::test {
namespace {

constexpr uint32_t kFiles = 300;

/// The same meshes without skins, without morph targets if so, and without animation.
TinyGltf unposed(const TinyGltf& file, bool morphs) {
    TinyGltf out = file;
    for (auto& node : out.json["nodes"]) {
        node.erase("skin");
        if (!morphs) node.erase("weights");
    }
    out.json.erase("skins");
    if (morphs) return out;
    out.json.erase("animations");
    for (auto& mesh : out.json["meshes"]) {
        mesh.erase("weights");
        for (auto& primitive : mesh["primitives"]) primitive.erase("targets");
    }
    return out;
}

std::vector<Corners> corners_only(const std::vector<TrueTriangle>& triangles) {
    std::vector<Corners> out;
    for (const TrueTriangle& one : triangles) out.push_back(one.corners);
    return out;
}

std::vector<TrueTriangle> truth_at(const TinyGltf& plain, double time_s) {
    CornerTruth truth(plain.json, {plain.bin});
    truth.play(0, time_s);
    return truth.triangles();
}

/// What a file shows at a time: by the reference, but for tangents that the file leaves to the
/// loader. Those are taken from the file without its skins, and moved by the reference.
std::vector<Corners> wanted_at(const TinyGltf& plain, double time_s) {
    std::vector<TrueTriangle> posed = truth_at(plain, time_s);
    const TinyGltf bare = unposed(plain, true);
    const std::vector<TrueTriangle> unmoved = truth_at(bare, time_s);
    const std::vector<Corners> loaded = corners_of(load_at(bare, time_s).scene);
    EXPECT_EQ(unmoved.size(), posed.size());
    for (TrueTriangle& triangle : posed)  // one that has an area by its pose only stays so
        for (Corner& corner : triangle.corners) corner.any_tangent = corner.tangent.empty();
    match(corners_only(unmoved), loaded, Compared::WithoutTangents,
          [&](size_t wanted, size_t found, size_t turned) {
              if (wanted >= posed.size()) return;
              for (size_t k = 0; k < 3; ++k) {
                  // A mirrored triangle runs the other way about in one of the two lists.
                  const bool swapped = posed[wanted].mirrored != unmoved[wanted].mirrored;
                  const size_t corner = swapped ? (3 - k) % 3 : k;
                  const Corner& from = loaded[found][(k + turned) % 3];
                  Corner& to = posed[wanted].corners[corner];
                  to.any_tangent = false;
                  if (from.tangent.empty() || !to.tangent.empty()) continue;
                  const bool skinned =
                      posed[wanted].to_world[corner] != unmoved[wanted].to_world[k];
                  to.tangent = skinned ? CornerTruth::moved_tangent(posed[wanted].to_world[corner],
                                                                    from.tangent)
                                       : from.tangent;
              }
          });
    return corners_only(posed);
}

io::GltfFile load_open(const TinyGltf& file, double time_s, double open_s) {
    return SavedGltf(file).at(time_s, open_s);
}

class Combined : public testing::Test {
  protected:
    /// Calls visit(file, plain twin) for each file, until one fails.
    template <class Visit>
    static void each_file(Visit visit) {
        for (uint32_t seed = 0; seed < kFiles && !HasFailure(); ++seed) {
            SCOPED_TRACE("seed " + std::to_string(seed));
            const CombinedGltf file(seed), plain(seed, true);
            ASSERT_NO_THROW(visit(file, plain));
        }
    }
};

TEST_F(Combined, AtRestAMeshIsAsIfItHadNoPose) {
    each_file([](const CombinedGltf& file, const CombinedGltf& plain) {
        const auto at_rest = corners_of(load_at(file, 0).scene);
        expect_same_corners(corners_of(load(unposed(plain, false)).scene), at_rest);
        expect_same_corners(at_rest, corners_of(load(file).scene));
    });
}

TEST_F(Combined, InAnyPoseAMeshIsThatOfTheReference) {
    each_file([](const CombinedGltf& file, const CombinedGltf& plain) {
        for (const double time_s : {0.5, 1.25})
            expect_same_corners(wanted_at(plain, time_s), corners_of(load_at(file, time_s).scene));
    });
}

/// Texture coordinates and colours are those of the middle while the shutter is open.
TEST_F(Combined, WhileTheShutterIsOpenBothEndsAreThoseOfTheReference) {
    each_file([](const CombinedGltf& file, const CombinedGltf& plain) {
        const io::GltfFile open = load_open(file, 1, 1);
        EXPECT_FALSE(contains_line(open.warnings, "broken"));
        const auto middle = truth_at(plain, 1);
        for (const float time : {0.f, 1.f}) {
            auto wanted = wanted_at(plain, 0.5 + double(time));
            for (size_t i = 0; i < wanted.size(); ++i)
                for (size_t k = 0; k < 3; ++k) wanted[i][k].rest = middle[i].corners[k].rest;
            expect_same_corners(wanted, corners_of(open.scene, time),
                                file.morphs_uv() ? Compared::WithoutTangents : Compared::All);
        }
    });
}

/// Beside one that follows the joints: it stands where its node does.
TEST(CombinedSkin, APrimitiveWithoutJointsDoesNotMoveWithThem) {
    AnimatedGltf file;
    file.add_root(nlohmann::json::object());
    file.add_channel(node_target(0, "rotation"), {0, 2}, "VEC4", {0, 0, 0, 1, 0, 0.6f, 0, 0.8f});
    file.add_probe();
    auto& primitives = file.json["meshes"][0]["primitives"];
    primitives.push_back(primitives[0]);
    auto& attributes = primitives[0]["attributes"];
    attributes["JOINTS_0"] = file.add_accessor<uint8_t>("VEC4", std::vector<uint8_t>(16, 0));
    attributes["WEIGHTS_0"] =
        file.add_accessor<float>("VEC4", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    file.add("skins", {{"joints", {0}}});
    file.add_root({{"mesh", 0}, {"skin", 0}, {"translation", {5, 0, 0}}});
    const io::GltfFile open = load_open(file, 1, 1);
    for (const float time : {0.f, 1.f})
        expect_same_corners(corners_only(truth_at(file, 0.5 + double(time))),
                            corners_of(open.scene, time));
}

}  // namespace
}  // namespace petzval::test
