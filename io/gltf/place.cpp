// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/place.h"

#include <Imath/ImathBoxAlgo.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <map>

#include "io/base/error.h"
#include "io/gltf/arrays.h"
#include "io/gltf/meshes/bake.h"
#include "io/gltf/meshes/flat.h"
#include "io/gltf/meshes/repair.h"
#include "io/gltf/meshes/tangents.h"
#include "io/gltf/meshes/triangles.h"
#include "io/gltf/placement.h"
#include "io/gltf/primitive.h"
#include "io/gltf/skin.h"
#include "io/gltf/strokes.h"

namespace petzval {
namespace {

/// Bytes that a triangle takes which is a light, in the tree of the lights too: rounded up.
constexpr double kLightBytes = 400;

template <class Vector>
bool all_finite(const std::vector<Vector>& values) {
    return std::all_of(values.begin(), values.end(), is_finite<Vector>);
}

class Placer {
  public:
    Placer(const GltfModel& gltf, const GltfNodes& nodes, const GltfVariant& variant,
           GltfMaterials& materials, Scene& scene, GltfTally& tally,
           std::optional<float> stroke_radius_m)
        : gltf_(gltf),
          nodes_(nodes),
          variant_(variant),
          materials_(materials),
          scene_(scene),
          tally_(tally),
          places_(gltf, nodes),
          memory_(gltf.file) {
        if (stroke_radius_m) strokes_.emplace(*stroke_radius_m);
    }

    void run() {
        for (const Placement& placement : find_placements(gltf_, nodes_, places_, tally_))
            place(placement);
        if (strokes_) strokes_->finish(scene_, materials_);
    }

  private:
    void place(const Placement& placement) {
        const auto& primitives = gltf_.typed.meshes[static_cast<size_t>(placement.mesh)].primitives;
        for (size_t i = 0; i < primitives.size(); ++i) {
            const std::string where = json_path("meshes", placement.mesh, "primitives", i);
            const Drawing drawing = drawing_of(primitives[i], tally_);
            const int material = variant_.material_of(placement.mesh, i, primitives[i].material);
            if (drawing == Drawing::Triangles)
                place_primitive(placement, primitives[i], materials_.use(material), where);
            else if (drawing != Drawing::Nothing)
                place_strokes(placement, primitives[i], material, where);
        }
    }

    void count(const BrokenValues& broken) {
        tally_.broken_triangles += broken.triangles;
        tally_.broken_values += broken.values;
    }

    void place_primitive(const Placement& placement, const tinygltf::Primitive& primitive,
                         uint32_t material, const std::string& where) {
        Mesh mesh = read_shaded(placement, primitive, material);
        mesh.material = material;
        if (mesh.triangles.empty()) return;

        const bool posed =
            placement.skin >= 0 && pose_by_skin(gltf_, nodes_, placement.skin, primitive, mesh);
        if (posed) tally_.honoured.insert("skins, in the pose that the nodes stand in");
        const bool baked = posed || placement.places == 1;
        if (baked && !posed)
            each_place(placement, [&](int, const M44d& to_world) { bake(mesh, to_world); });
        check_finite(mesh, where);
        tally_.zero_area_triangles += remove_zero_area(mesh);
        if (mesh.triangles.empty()) return;

        const Material& of_mesh = scene_.materials[material];
        if (of_mesh.emits() && !of_mesh.unlit)
            memory_.ask(kLightBytes, placement.places, mesh.triangles.size(), where);
        const auto index = static_cast<uint32_t>(scene_.meshes.size());
        scene_.meshes.push_back(std::move(mesh));
        if (baked) {
            scene_.instances.push_back({.mesh = index, .to_world = {}, .to_local = {}});
            return;
        }
        tally_.honoured.insert("mesh instancing");
        memory_.ask(kInstanceBytes, placement.places, 1, where);
        reserve(placement.places);
        Box3f bounds;
        for (const V3f& position : scene_.meshes[index].positions) bounds.extendBy(position);
        each_place(placement, [&](int node, const M44d& to_world) {
            scene_.instances.push_back(instance(index, node, to_world, bounds));
        });
    }

    void place_strokes(const Placement& placement, const tinygltf::Primitive& primitive,
                       int material_of_file, const std::string& where) {
        if (!strokes_) {
            ++(primitive.mode == TINYGLTF_MODE_POINTS ? tally_.point_primitives
                                                      : tally_.line_primitives);
            return;
        }
        StrokeSource source = read_stroke(gltf_, primitive, placement.morph_weights, tally_);
        Mesh& vertices = source.vertices;
        const StrokeShapes shapes = shapes_of(source, primitive.mode, tally_.broken_strokes);
        count(repair_values(vertices));
        memory_.ask(kInstanceBytes, placement.places,
                    shapes.spheres.size() + shapes.cylinders.size(), where);
        const uint32_t material = materials_.use(material_of_file);
        tally_.honoured.insert("points and lines, as spheres and cylinders");
        if (placement.skin >= 0 &&
            pose_by_skin(gltf_, nodes_, placement.skin, primitive, vertices)) {
            strokes_->add(material, vertices, shapes, M44d());
            return;
        }
        each_place(placement, [&](int, const M44d& to_world) {
            strokes_->add(material, vertices, shapes, to_world);
        });
    }

    // Calls visit(node, matrix) for each place where something shows.
    template <class Visit>
    void each_place(const Placement& placement, Visit visit) {
        for (const int node : placement.nodes) {
            const auto visit_shown = [&](const M44d& to_world) {
                if (!Places::shows(to_world) && placement.skin < 0) return;
                visit(node, dimensions_left(to_world) == 2 ? thickened(to_world, box_of(placement))
                                                           : to_world);
            };
            if (placement.skin >= 0)
                visit_shown(places_.of_node(node));
            else
                places_.each(node, visit_shown);
        }
    }

    // Box about all vertices of a mesh, with those of its primitives that go together.
    const Box3f& box_of(const Placement& placement) {
        const auto [at, is_new] = boxes_.try_emplace(placement.mesh);
        if (!is_new) return at->second;
        for (const auto& primitive :
             gltf_.typed.meshes[static_cast<size_t>(placement.mesh)].primitives) {
            const int positions = attribute(primitive, "POSITION");
            if (positions < 0) continue;
            for (const V3f& p : read_vec3(gltf_, positions))
                if (is_finite(p)) at->second.extendBy(p);
        }
        if (at->second.isEmpty()) at->second = Box3f(V3f(0.f));
        return at->second;
    }

    void reserve(size_t more) {
        auto& instances = scene_.instances;
        const size_t needed = instances.size() + more;
        if (needed > instances.capacity())
            instances.reserve(std::max(needed, instances.size() + instances.size() / 2));
    }

    // Tangents are found before the mesh is moved, so that every copy of it shades alike.
    Mesh read_shaded(const Placement& placement, const tinygltf::Primitive& primitive,
                     uint32_t material_index) {
        const Material& material = scene_.materials[material_index];
        const bool with_tangents = material.needs_tangents();
        Mesh mesh = read_primitive(
            gltf_, primitive,
            {placement.morph_weights, with_tangents, materials_.more_sets(material_index)}, tally_);
        count(repair_values(mesh));
        tally_.unmapped_primitives += add_missing_uv(mesh, material);
        tally_.replaced_normals += repair_normals(mesh);
        repair_tangents(mesh);
        if (with_tangents && mesh.tangents.empty()) {
            add_tangents(mesh, material.tangent_slot());
            tally_.honoured.insert("tangents computed for normal maps");
        }
        return mesh;
    }

    Instance instance(uint32_t mesh, int node, const M44d& to_world, const Box3f& bounds) const {
        const M44d to_local = to_world.inverse();
        const Instance made{.mesh = mesh,
                            .identity = false,
                            .flips = relative_determinant(to_world) < 0,
                            .to_world = M44f(to_world),
                            .to_local = M33f(linear_part(to_local))};
        const Box3f placed = Imath::transform(bounds, made.to_world);
        const Box3f back = Imath::transform(placed, M44f(to_local));
        if (!is_finite(placed.min) || !is_finite(placed.max) || !is_finite(back.min) ||
            !is_finite(back.max))
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
        require(all_finite(mesh.positions), "POSITION");
        require(all_finite(mesh.uv[0]), "TEXCOORD_0");
        require(all_finite(mesh.uv[1]), "TEXCOORD_1");
        for (const auto& uv : mesh.more_uv) require(all_finite(uv), "TEXCOORD_n");
        require(all_finite(mesh.colours), "COLOR_0");
    }

    const GltfModel& gltf_;
    const GltfNodes& nodes_;
    const GltfVariant& variant_;
    GltfMaterials& materials_;
    Scene& scene_;
    GltfTally& tally_;
    Places places_;
    std::optional<Strokes> strokes_;
    std::map<int, Box3f> boxes_;  ///< of meshes that are flattened somewhere
    PlaceMemory memory_;
};

}  // namespace

void place_meshes(const GltfModel& gltf, const GltfNodes& nodes, const GltfVariant& variant,
                  GltfMaterials& materials, Scene& scene, GltfTally& tally,
                  std::optional<float> stroke_radius_m) {
    Placer(gltf, nodes, variant, materials, scene, tally, stroke_radius_m).run();
}

}  // namespace petzval
