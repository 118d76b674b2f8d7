// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/place.h"

#include <Imath/ImathBoxAlgo.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>

#include "io/base/error.h"
#include "io/gltf/bake.h"
#include "io/gltf/primitive.h"
#include "io/gltf/repair.h"
#include "io/gltf/skin.h"
#include "io/gltf/tangents.h"
#include "io/gltf/triangles.h"

namespace petzval {
namespace {

/// Nodes that show the same mesh in the same shape.
struct Placement {
    int mesh = -1, skin = -1;
    std::vector<double> morph_weights;
    std::vector<int> nodes;
};

bool fits_floats(const M44d& m) {
    constexpr double greatest = std::numeric_limits<float>::max();
    const double* const first = m.getValue();
    return std::all_of(first, first + 16, [](double x) { return std::fabs(x) <= greatest; });
}

// Placements of the meshes. Nodes whose matrix flattens space show nothing, except where a skin
// places the mesh instead.
std::vector<Placement> group_nodes(const GltfModel& gltf, const GltfNodes& nodes,
                                   GltfTally& tally) {
    std::vector<Placement> placements;
    std::map<std::pair<int, std::vector<double>>, size_t> known;
    for (int index : nodes.in_scene) {
        const GltfNode& node = nodes.node[static_cast<size_t>(index)];
        if (node.mesh < 0) continue;
        const M44d& to_world = nodes.to_world[static_cast<size_t>(index)];
        if (!fits_floats(to_world))
            throw InputError(gltf.file, json_path("nodes", index),
                             "places its mesh beyond the range of a float");
        if (node.skin < 0 && is_singular(to_world)) {
            ++tally.singular_nodes;
            continue;
        }
        const auto& mesh = gltf.typed.meshes.at(static_cast<size_t>(node.mesh));
        const auto& weights = node.weights.empty() ? mesh.weights : node.weights;
        size_t at = placements.size();
        if (node.skin < 0) at = known.try_emplace({node.mesh, weights}, at).first->second;
        if (at == placements.size()) placements.push_back({node.mesh, node.skin, weights, {}});
        placements[at].nodes.push_back(index);
    }
    return placements;
}

template <class Values>
bool all_finite(const Values& values, int components) {
    return std::all_of(values.begin(), values.end(), [&](const auto& value) {
        for (int k = 0; k < components; ++k)
            if (!std::isfinite(value[k])) return false;
        return true;
    });
}

class Placer {
  public:
    Placer(const GltfModel& gltf, const GltfNodes& nodes, const GltfVariant& variant,
           GltfMaterials& materials, Scene& scene, GltfTally& tally)
        : gltf_(gltf),
          nodes_(nodes),
          variant_(variant),
          materials_(materials),
          scene_(scene),
          tally_(tally) {}

    void place(const Placement& placement) {
        const auto& primitives = gltf_.typed.meshes[static_cast<size_t>(placement.mesh)].primitives;
        for (size_t i = 0; i < primitives.size(); ++i) {
            if (!is_drawn(primitives[i], tally_)) continue;
            const int material = variant_.material_of(placement.mesh, i, primitives[i].material);
            place_primitive(placement, primitives[i], materials_.use(material),
                            json_path("meshes", placement.mesh, "primitives", i));
        }
    }

  private:
    void place_primitive(const Placement& placement, const tinygltf::Primitive& primitive,
                         uint32_t material, const std::string& where) {
        Mesh mesh = read_shaded(placement, primitive, scene_.materials[material]);
        mesh.material = material;
        if (mesh.triangles.empty()) return;

        const bool posed =
            placement.skin >= 0 && pose_by_skin(gltf_, nodes_, placement.skin, primitive, mesh);
        if (posed) tally_.honoured.insert("skins, in the pose that the nodes stand in");
        const bool baked = posed || placement.nodes.size() == 1;
        if (baked && !posed) bake(mesh, matrix_of(placement.nodes.front()));
        check_finite(mesh, where);
        tally_.zero_area_triangles += remove_zero_area(mesh);
        if (mesh.triangles.empty()) return;

        const auto index = static_cast<uint32_t>(scene_.meshes.size());
        scene_.meshes.push_back(std::move(mesh));
        if (baked) {
            scene_.instances.push_back({.mesh = index, .to_world = {}, .to_local = {}});
            return;
        }
        tally_.honoured.insert("mesh instancing");
        Box3f bounds;
        for (const V3f& position : scene_.meshes[index].positions) bounds.extendBy(position);
        for (int node : placement.nodes) scene_.instances.push_back(instance(index, node, bounds));
    }

    // Tangents are found before the mesh is moved, so that every copy of it shades alike.
    Mesh read_shaded(const Placement& placement, const tinygltf::Primitive& primitive,
                     const Material& material) {
        const bool with_tangents = material.needs_tangents();
        Mesh mesh =
            read_primitive(gltf_, primitive, placement.morph_weights, with_tangents, tally_);
        repair_values(mesh, tally_);
        tally_.unmapped_primitives += add_missing_uv(mesh, material);
        tally_.replaced_normals += repair_normals(mesh);
        repair_tangents(mesh);
        if (with_tangents && mesh.tangents.empty()) {
            add_tangents(mesh, material.tangent_slot());
            tally_.honoured.insert("tangents computed for normal maps");
        }
        return mesh;
    }

    const M44d& matrix_of(int node) const { return nodes_.to_world[static_cast<size_t>(node)]; }

    Instance instance(uint32_t mesh, int node, const Box3f& bounds) const {
        const M44d& to_world = matrix_of(node);
        const Instance made{.mesh = mesh,
                            .identity = false,
                            .flips = relative_determinant(to_world) < 0,
                            .to_world = M44f(to_world),
                            .to_local = M44f(to_world.inverse())};
        const Box3f placed = Imath::transform(bounds, made.to_world);
        const Box3f back = Imath::transform(placed, made.to_local);
        if (!all_finite(std::array{placed.min, placed.max, back.min, back.max}, 3))
            throw InputError(gltf_.file, json_path("nodes", node),
                             "places its mesh beyond the range of a float");
        return made;
    }

    void check_finite(const Mesh& mesh, const std::string& where) const {
        const auto require = [&](bool good, const char* what) {
            if (!good)
                throw InputError(gltf_.file, where + "/attributes/" + what,
                                 "holds a number that is not finite in the scene");
        };
        require(all_finite(mesh.positions, 3), "POSITION");
        require(all_finite(mesh.uv[0], 2), "TEXCOORD_0");
        require(all_finite(mesh.uv[1], 2), "TEXCOORD_1");
        require(all_finite(mesh.colours, 4), "COLOR_0");
    }

    const GltfModel& gltf_;
    const GltfNodes& nodes_;
    const GltfVariant& variant_;
    GltfMaterials& materials_;
    Scene& scene_;
    GltfTally& tally_;
};

}  // namespace

void place_meshes(const GltfModel& gltf, const GltfNodes& nodes, const GltfVariant& variant,
                  GltfMaterials& materials, Scene& scene, GltfTally& tally) {
    Placer placer(gltf, nodes, variant, materials, scene, tally);
    for (const Placement& placement : group_nodes(gltf, nodes, tally)) placer.place(placement);
}

}  // namespace petzval
