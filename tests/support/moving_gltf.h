// SPDX-License-Identifier: Apache-2.0
// Tiny glTF files that move, loaded at a moment or while a shutter is open.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/scene/motion.h"
#include "tests/support/load_tiny_gltf.h"

namespace petzval::test {

using nlohmann::json;

/// Adds a channel to the file's one animation.
inline void animate(TinyGltf& file, int node, const std::string& path,
                    const std::vector<float>& times_s, const std::vector<float>& values,
                    const std::string& interpolation = "LINEAR") {
    json& animation = file.json["animations"][0];
    const char* const type = path == "rotation" ? "VEC4" : path == "weights" ? "SCALAR" : "VEC3";
    const int input = file.add_accessor<float>(
        "SCALAR", times_s, {{"min", {times_s.front()}}, {"max", {times_s.back()}}});
    const int output = file.add_accessor<float>(type, values);
    animation["samplers"].push_back(
        {{"input", input}, {"output", output}, {"interpolation", interpolation}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
}

/// Quaternion of a turn about an axis of length 1.
[[nodiscard]] inline std::vector<float> quaternion(const V3d& axis, double degrees) {
    const double half = degrees * M_PI / 360, s = std::sin(half);
    return {float(axis.x * s), float(axis.y * s), float(axis.z * s), float(std::cos(half))};
}

/// Turns a node about an axis, by so many degrees in all, evenly over a second: with keys that lie
/// less than half a turn apart.
inline void spin(TinyGltf& file, int node, const V3d& axis, double degrees) {
    const int keys = 2 + static_cast<int>(std::fabs(degrees) / 120);
    std::vector<float> times, values;
    for (int i = 0; i < keys; ++i) {
        times.push_back(float(i) / float(keys - 1));
        const auto q = quaternion(axis, degrees * i / (keys - 1));
        values.insert(values.end(), q.begin(), q.end());
    }
    animate(file, node, "rotation", times, values);
}

/// A file that is saved once and loaded at many times.
class SavedGltf {
  public:
    explicit SavedGltf(const TinyGltf& file) : path_(file.save_glb(folder_.path / "moves.glb")) {}

    /// open_s: how long the shutter is open about that time; 0: a still.
    [[nodiscard]] io::GltfFile at(double time_s, double open_s = 0, bool repeats = true) const {
        io::GltfChoices choices;
        choices.animation = io::AnimationChoice{time_s, {}, repeats, open_s};
        io::PictureBudget pictures;
        return io::load_gltf(path_, io::FileScope::Anywhere, pictures, choices);
    }

  private:
    TempFolder folder_;
    std::filesystem::path path_;
};

/// A triangle in the world, and which way its front faces.
struct PlacedTriangle {
    std::array<V3f, 3> corners;
    V3f front;
};

[[nodiscard]] inline std::vector<PlacedTriangle> triangles_at(const Scene& scene, float time) {
    std::vector<PlacedTriangle> out;
    for (uint32_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        for (uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto c = triangle_corners(scene, i, t, time);
            const V3f n = (c[1] - c[0]).cross(c[2] - c[0]);
            out.push_back({c, flips_at(scene, i, time) ? -n : n});
        }
    }
    return out;
}

/// Greatest distance of a corner from where it is in a list of the same triangles.
[[nodiscard]] inline double apart(const std::vector<PlacedTriangle>& a,
                                  const std::vector<PlacedTriangle>& b) {
    double most = a.size() == b.size() ? 0 : HUGE_VAL;
    for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        for (size_t k = 0; k < 3; ++k)
            most = std::max(most, double((a[i].corners[k] - b[i].corners[k]).length()));
    return most;
}

/// Whether both lists hold the same triangles, facing the same way, in any order.
[[nodiscard]] inline ::testing::AssertionResult same_triangles(const std::vector<PlacedTriangle>& a,
                                                               const std::vector<PlacedTriangle>& b,
                                                               float tolerance) {
    if (a.size() != b.size())
        return ::testing::AssertionFailure()
               << a.size() << " triangles are not " << b.size() << " triangles";
    for (const PlacedTriangle& one : a) {
        float least = kInfinity;
        for (const PlacedTriangle& other : b) {
            float most = (one.front - other.front).length();
            for (const V3f& corner : one.corners) {
                float nearest = kInfinity;
                for (const V3f& c : other.corners)
                    nearest = std::min(nearest, (corner - c).length());
                most = std::max(most, nearest);
            }
            least = std::min(least, most);
        }
        if (!(least <= tolerance))
            return ::testing::AssertionFailure()
                   << "the triangle of " << one.corners[0] << one.corners[1] << one.corners[2]
                   << " is off by " << least;
    }
    return ::testing::AssertionSuccess();
}

}  // namespace petzval::test
