// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/geometry/primitive.h"

#include <fmt/format.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <numeric>

#include "io/gltf/document/arrays.h"
#include "io/gltf/meshes/triangles.h"

namespace petzval::io {
namespace {

/// One primitive on its way to a Mesh.
class PrimitiveReader {
  public:
    PrimitiveReader(const GltfModel& gltf, const tinygltf::Primitive& primitive, GltfTally& tally)
        : gltf_(gltf), primitive_(primitive), tally_(tally) {}

    void read_attributes(Mesh& mesh, bool with_tangents, const std::vector<uint64_t>& more_sets) {
        mesh.positions = read_vec3(gltf_, attribute(primitive_, "POSITION"));
        mesh.normals = read("NORMAL", read_vec3);
        if (with_tangents && !mesh.normals.empty())  // flat normals void the file's tangents
            mesh.tangents = read("TANGENT", read_vec4);
        mesh.uv = {read("TEXCOORD_0", read_vec2), read("TEXCOORD_1", read_vec2)};
        for (const uint64_t set : more_sets) {
            more_names_.push_back(fmt::format("TEXCOORD_{}", set));
            mesh.more_uv.push_back(read(more_names_.back(), read_vec2));
        }
        mesh.colours = read("COLOR_0", read_vec4);
        if (!mesh.colours.empty()) tally_.honoured.insert("vertex colours");
    }

    [[nodiscard]] std::vector<uint32_t> read_order(const Mesh& mesh) const {
        if (primitive_.indices >= 0) return read_indices(gltf_, primitive_.indices);
        tally_.honoured.insert("geometry without indices");
        std::vector<uint32_t> order(mesh.positions.size());
        std::iota(order.begin(), order.end(), 0u);
        return order;
    }

    void read_triangles(Mesh& mesh) const {
        const std::vector<uint32_t> index = read_order(mesh);
        const TriangleMode mode = triangle_mode();
        if (index.size() < 3 || (mode == TriangleMode::List && index.size() % 3 != 0))
            ++tally_.incomplete_primitives;
        mesh.triangles = to_triangles(mode, index);
    }

    void add_morph_targets(Mesh& mesh, const std::vector<double>& weights) const {
        bool clamps_colours = false;
        for (size_t i = 0; i < std::min(weights.size(), primitive_.targets.size()); ++i) {
            const auto weight = static_cast<float>(weights[i]);
            if (weight == 0.f) continue;
            for (const auto& [name, accessor] : primitive_.targets[i])
                add_target(mesh, name, accessor, weight);
            if (primitive_.targets[i].contains("COLOR_0")) clamps_colours = true;
            tally_.honoured.insert("morph targets, with the stored weights");
        }
        if (!clamps_colours) return;
        for (V4f& c : mesh.colours)  // as glTF 2.0, section 3.7.2.2 asks after morphing
            for (int k = 0; k < 4; ++k) c[k] = std::clamp(c[k], 0.f, 1.f);
    }

  private:
    template <class Value>
    std::vector<Value> read(const std::string& name,
                            std::vector<Value> (*reader)(const GltfModel&, int)) const {
        const int accessor = attribute(primitive_, name);
        if (accessor < 0) return {};
        return reader(gltf_, accessor);
    }

    [[nodiscard]] TriangleMode triangle_mode() const {
        if (primitive_.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            tally_.honoured.insert("triangle strips");
            return TriangleMode::Strip;
        }
        if (primitive_.mode == TINYGLTF_MODE_TRIANGLE_FAN) {
            tally_.honoured.insert("triangle fans");
            return TriangleMode::Fan;
        }
        return TriangleMode::List;
    }

    // Adds an attribute of a morph target. Its tangents have no w; it may change an attribute only
    // where there is one.
    void add_target(Mesh& mesh, const std::string& name, int accessor, float weight) const {
        if (name == "POSITION") add(mesh.positions, read_vec3(gltf_, accessor), weight);
        if (name == "NORMAL") add(mesh.normals, read_vec3(gltf_, accessor), weight);
        if (name == "TANGENT") add(mesh.tangents, read_vec3(gltf_, accessor), weight);
        if (name == "TEXCOORD_0") add(mesh.uv[0], read_vec2(gltf_, accessor), weight);
        if (name == "TEXCOORD_1") add(mesh.uv[1], read_vec2(gltf_, accessor), weight);
        for (size_t i = 0; i < more_names_.size(); ++i)
            if (name == more_names_[i]) add(mesh.more_uv[i], read_vec2(gltf_, accessor), weight);
        if (name == "COLOR_0") add_colours(mesh.colours, accessor, weight);
    }

    void add_colours(std::vector<V4f>& to, int accessor, float weight) const {
        if (accessor_of(gltf_, accessor).components == 3)
            add(to, read_vec3(gltf_, accessor), weight);
        else
            add(to, read_vec4(gltf_, accessor), weight);
    }

    template <class To, class Delta>
    static void add(std::vector<To>& to, const std::vector<Delta>& deltas, float weight) {
        for (size_t i = 0; i < to.size(); ++i)  // `to` is empty where it is of no use
            for (unsigned k = 0; k < Delta::dimensions(); ++k)
                to[i][static_cast<int>(k)] += weight * deltas[i][static_cast<int>(k)];
    }

    const GltfModel& gltf_;
    const tinygltf::Primitive& primitive_;
    GltfTally& tally_;
    std::vector<std::string> more_names_;  ///< of the attributes in Mesh::more_uv
};

}  // namespace

int attribute(const tinygltf::Primitive& primitive, const std::string& name) {
    const auto found = primitive.attributes.find(name);
    return found == primitive.attributes.end() ? -1 : found->second;
}

Drawing drawing_of(const tinygltf::Primitive& primitive, GltfTally& tally) {
    if (primitive.mode > TINYGLTF_MODE_TRIANGLE_FAN)  // warned of by the checks
        return Drawing::Nothing;
    if (attribute(primitive, "POSITION") < 0) {
        ++tally.primitives_without_positions;
        return Drawing::Nothing;
    }
    if (primitive.mode >= TINYGLTF_MODE_TRIANGLES) return Drawing::Triangles;
    return primitive.mode == TINYGLTF_MODE_POINTS ? Drawing::Points : Drawing::Lines;
}

Mesh read_primitive(const GltfModel& gltf, const tinygltf::Primitive& primitive,
                    const PrimitiveRequest& asked, GltfTally& tally) {
    PrimitiveReader reader(gltf, primitive, tally);
    Mesh mesh;
    reader.read_attributes(mesh, asked.with_tangents, asked.more_sets);
    reader.add_morph_targets(mesh, asked.morph_weights);
    reader.read_triangles(mesh);
    return mesh;
}

StrokeSource read_stroke(const GltfModel& gltf, const tinygltf::Primitive& primitive,
                         const std::vector<double>& morph_weights, GltfTally& tally) {
    PrimitiveReader reader(gltf, primitive, tally);
    StrokeSource source;
    reader.read_attributes(source.vertices.mesh, false, {});
    reader.add_morph_targets(source.vertices.mesh, morph_weights);
    source.order = reader.read_order(source.vertices.mesh);
    return source;
}

}  // namespace petzval::io
