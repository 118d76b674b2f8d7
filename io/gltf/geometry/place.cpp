// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/geometry/place.h"

#include <Imath/ImathBoxAlgo.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <array>
#include <map>

#include "io/base/error.h"
#include "io/gltf/animation/thinning.h"
#include "io/gltf/document/arrays.h"
#include "io/gltf/geometry/placement.h"
#include "io/gltf/geometry/primitive.h"
#include "io/gltf/geometry/skin.h"
#include "io/gltf/geometry/strokes.h"
#include "io/gltf/meshes/bake.h"
#include "io/gltf/meshes/flat.h"
#include "io/gltf/meshes/matrix.h"
#include "io/gltf/meshes/repair.h"
#include "io/gltf/meshes/tangents.h"
#include "io/gltf/meshes/triangles.h"

namespace petzval::io {
namespace {

/// Bytes that a triangle takes which is a light, in the tree of the lights too: rounded up.
constexpr double kLightBytes = 400;
/// Bytes of a time step of a vertex, and of the place of an instance, in the BVH too: rounded up.
constexpr double kVertexStepBytes = 60, kPlaceStepBytes = 320;

template <class Vector>
bool all_finite(const std::vector<Vector>& values) {
    return std::all_of(values.begin(), values.end(), is_finite<Vector>);
}

class Placer {
  public:
    Placer(const GltfModel& gltf, const GltfNodes& nodes, const NodeMotion& motion,
           const GltfVariant& variant, GltfMaterials& materials, Scene& scene, GltfTally& tally,
           std::optional<float> stroke_radius_m)
        : gltf_(gltf),
          nodes_(nodes),
          motion_(motion),
          variant_(variant),
          materials_(materials),
          scene_(scene),
          tally_(tally),
          places_(gltf, nodes),
          memory_(gltf.file) {
        if (stroke_radius_m) strokes_.emplace(*stroke_radius_m);
    }

    void run() {
        for (const Placement& placement : find_placements(gltf_, nodes_, motion_, places_, tally_))
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

    static void count(const BrokenValues& broken, GltfTally& tally) {
        tally.broken_triangles += broken.triangles;
        tally.broken_values += broken.values;
    }

    void place_primitive(const Placement& placement, const tinygltf::Primitive& primitive,
                         uint32_t material, const std::string& where) {
        SourceMesh source = read_shaded(placement.morph_weights, primitive, material);
        Mesh& mesh = source.mesh;
        if (mesh.triangles.empty()) return;

        const bool deforming = deforms(placement, primitive);
        const SourceMesh unposed = deforming ? source : SourceMesh();
        const bool posed = pose(placement, primitive, std::nullopt, source);
        if (posed) tally_.honoured.insert("skins, in the pose that the nodes stand in");
        const bool baked =
            posed || (placement.places == 1 && !placement.moves && !placement.morphs);
        if (baked && !posed)
            each_place(placement,
                       [&](int, const M44d& to_world, const M44d&) { bake(mesh, to_world); });
        const std::optional<Thinning> deformation =
            deforming ? add_steps(placement, primitive, unposed, mesh) : std::nullopt;
        check_finite(mesh, where);
        // What has no area now may have some at another time.
        if (mesh.steps.empty()) tally_.zero_area_triangles += remove_zero_area(mesh);
        if (mesh.triangles.empty()) return;

        const Material& of_mesh = scene_.materials[material];
        if (of_mesh.emits() && !of_mesh.unlit)
            memory_.ask(kLightBytes, placement.places, mesh.triangles.size(), where);
        const auto index = static_cast<uint32_t>(scene_.meshes.size());
        const bool deforms_here = !mesh.steps.empty();
        scene_.meshes.push_back(std::move(mesh));
        if (baked) {
            scene_.instances.push_back(
                {.mesh = index, .moves = deforms_here, .to_world = {}, .to_local = {}});
            if (deformation) note_off(*deformation);
            return;
        }
        tally_.honoured.insert("mesh instancing");
        memory_.ask(kInstanceBytes, placement.places, 1, where);
        reserve(placement.places);
        Box3f bounds = box_about(scene_.meshes[index].positions);
        for (const MeshStep& step : scene_.meshes[index].steps)
            bounds.extendBy(box_about(step.positions));
        each_place(placement, [&](int node, const M44d& to_world, const M44d& own) {
            scene_.instances.push_back(instance(index, node, to_world, bounds));
            scene_.instances.back().moves = deforms_here;
            const auto* const places = motion_.places(node);
            if (!places && deformation) note_off(deformation->scaled(stretch(to_world)));
            if (places) move_instance(node, *places, {to_world, own}, bounds, deformation);
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
        Mesh& vertices = source.vertices.mesh;
        const StrokeShapes shapes = shapes_of(source, primitive.mode, tally_.broken_strokes);
        count(repair_values(vertices), tally_);
        memory_.ask(kInstanceBytes, placement.places,
                    shapes.spheres.size() + shapes.cylinders.size(), where);
        const uint32_t material = materials_.use(material_of_file);
        tally_.honoured.insert("points and lines, as spheres and cylinders");
        if (placement.moves || deforms(placement, primitive)) {
            tally_.held.insert("points and lines");
            tally_.warnings.add(where,
                                "moving points and lines are shown as they are in "
                                "the middle of the exposure");
        }
        if (pose(placement, primitive, std::nullopt, source.vertices)) {
            strokes_->add(material, vertices, shapes, M44d());
            return;
        }
        each_place(placement, [&](int, const M44d& to_world, const M44d&) {
            strokes_->add(material, vertices, shapes, to_world);
        });
    }

    // Whether the shape of a mesh changes while the shutter is open.
    [[nodiscard]] bool deforms(const Placement& placement,
                               const tinygltf::Primitive& primitive) const {
        if (placement.morphs) return true;
        if (placement.skin < 0 || !has_joints(primitive)) return false;
        const auto& joints = gltf_.typed.skins[static_cast<size_t>(placement.skin)].joints;
        return std::any_of(joints.begin(), joints.end(),
                           [&](int node) { return motion_.places(node) != nullptr; });
    }

    [[nodiscard]] std::vector<M44d> joints_at(const Placement& placement,
                                              std::optional<size_t> step) const {
        return joint_matrices(gltf_, placement.skin, [&](int node) {
            const auto* const places = motion_.places(node);
            return step && places ? (*places)[*step] : places_.of_node(node);
        });
    }

    // Moves a mesh by its skin as it is at a time step, or in the middle; false where it has none.
    bool pose(const Placement& placement, const tinygltf::Primitive& primitive,
              std::optional<size_t> step, SourceMesh& mesh) const {
        return placement.skin >= 0 &&
               pose_by_skin(gltf_, joints_at(placement, step), primitive, mesh);
    }

    // Adds the shapes that a mesh takes while the shutter is open, at as few steps as will do;
    // tells how well that follows them, in the mesh's own space or, with a skin, in the world.
    std::optional<Thinning> add_steps(const Placement& placement,
                                      const tinygltf::Primitive& primitive,
                                      const SourceMesh& unposed, Mesh& mesh) {
        const Thinning thinning = thinning_of(placement, primitive, unposed.mesh);
        memory_.ask(kVertexStepBytes, 1, mesh.positions.size(), json_path("meshes", placement.mesh),
                    (motion_.steps() - 1) / thinning.stride + 1);
        const auto* const weights = motion_.weights(placement.nodes.front());
        for (size_t step = 0; step < motion_.steps(); step += thinning.stride) {
            SourceMesh shape = unposed;
            if (weights && !reshape(shape, (*weights)[step], primitive)) {
                mesh.steps.clear();
                tally_.warnings.add(json_path("meshes", placement.mesh),
                                    "its shape is broken at times; it keeps that of the "
                                    "middle of the exposure");
                return std::nullopt;
            }
            (void)pose(placement, primitive, step, shape);
            mesh.steps.push_back({std::move(shape.mesh.positions), std::move(shape.mesh.normals),
                                  std::move(shape.mesh.tangents)});
        }
        ++tally_.deforming_meshes;
        return thinning;
    }

    void note_off(const Thinning& thinning) {
        tally_.motion_off_m = std::max(tally_.motion_off_m, thinning.off_m);
        if (thinning.size_m > 0)
            tally_.motion_off = std::max(tally_.motion_off, thinning.off_m / thinning.size_m);
    }

    [[nodiscard]] Thinning thinning_of(const Placement& placement,
                                       const tinygltf::Primitive& primitive,
                                       const Mesh& unposed) const {
        Box3f box = box_about(unposed.positions);
        const double size_m = double(box.size().length());
        Thinning all{.stride = motion_.steps() - 1};
        if (const auto* const weights = motion_.weights(placement.nodes.front())) {
            std::vector<double> sizes_m;
            double reach_m = 0;  // of a point, by all targets together
            for (const auto& target : primitive.targets) {
                double most = 0, weight = 0;
                if (const auto at = target.find("POSITION"); at != target.end())
                    for (const V3f& delta : read_vec3(gltf_, at->second))
                        most = std::max(most, double(delta.length()));
                for (const std::vector<double>& step : *weights)
                    if (sizes_m.size() < step.size())
                        weight = std::max(weight, std::fabs(step[sizes_m.size()]));
                sizes_m.push_back(most);
                reach_m += 2 * weight * most;
            }
            all = thin(*weights, sizes_m, size_m);
            box.min -= V3f(static_cast<float>(reach_m));
            box.max += V3f(static_cast<float>(reach_m));
        }
        if (placement.skin < 0) return all;
        std::vector<std::vector<M44d>> by_joint;
        double most_stretch = 0;
        for (size_t step = 0; step < motion_.steps(); ++step) {
            const std::vector<M44d> joints = joints_at(placement, step);
            by_joint.resize(joints.size());
            for (size_t j = 0; j < joints.size(); ++j) {
                by_joint[j].push_back(joints[j]);
                most_stretch = std::max(most_stretch, stretch(joints[j]));
            }
        }
        const double morphed_m = all.off_m * most_stretch;
        all.off_m = all.size_m = 0;
        for (const auto& joint : by_joint) all = all | thin(joint, corners_of(box));
        all.off_m += morphed_m;  // a point is off by both
        return all;
    }

    [[nodiscard]] static Box3f box_about(const std::vector<V3f>& positions) {
        Box3f box;
        for (const V3f& p : positions) box.extendBy(p);
        return box;
    }

    [[nodiscard]] static std::array<V3d, 8> corners_of(const Box3f& box) {
        std::array<V3d, 8> corners;
        for (size_t i = 0; i < 8; ++i)
            corners[i] = V3d((i & 1 ? box.max : box.min).x, (i & 2 ? box.max : box.min).y,
                             (i & 4 ? box.max : box.min).z);
        return corners;
    }

    struct InstancePlace {
        M44d to_world;  ///< one that does not flatten space
        M44d own;       ///< in the node's own space
    };
    // Makes the last instance move as its node does.
    void move_instance(int node, const std::vector<M44d>& places, const InstancePlace& at,
                       const Box3f& bounds, const std::optional<Thinning>& deformation) {
        std::vector<M44d> all;
        double most_stretch = 0;
        for (const M44d& place : places) {
            all.push_back(at.own * place);
            if (dimensions_left(all.back()) == 2)
                all.back() = thickened(all.back(), bounds);
            else if (is_singular(all.back()))
                add_thickness(all.back(), at.to_world);
            most_stretch = std::max(most_stretch, stretch(all.back()));
        }
        Thinning thinning = thin(all, corners_of(bounds));
        if (deformation) thinning.off_m += most_stretch * deformation->off_m;
        memory_.ask(kPlaceStepBytes, 1, 1, json_path("nodes", node),
                    (all.size() - 1) / thinning.stride + 1);
        InstanceMotion motion;
        for (size_t step = 0; step < all.size(); step += thinning.stride) {
            (void)instance(0, node, all[step], bounds);  // for its checks
            motion.to_world.emplace_back(all[step]);
        }
        scene_.motion_of.resize(scene_.instances.size(), -1);
        scene_.motion_of.back() = static_cast<int32_t>(scene_.motions.size());
        scene_.motions.push_back(std::move(motion));
        scene_.instances.back().moves = true;
        ++tally_.moving_instances;
        note_off(thinning);
    }

    // Gives a matrix that leaves nothing to see for a moment a little of what it is at another.
    static void add_thickness(M44d& flat, const M44d& other) {
        constexpr double share = 1e-4;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) flat[i][j] += share * other[i][j];
    }

    // Calls visit(node, matrix, own) for each place where something shows; own: the place in the
    // node's own space.
    template <class Visit>
    void each_place(const Placement& placement, Visit visit) {
        for (const int node : placement.nodes) {
            const auto visit_shown = [&](const M44d& in_the_middle, const M44d& own) {
                const M44d to_world = shown_place(motion_, node, in_the_middle, own);
                if (!Places::shows(to_world) && placement.skin < 0) return;
                visit(node,
                      dimensions_left(to_world) == 2 ? thickened(to_world, box_of(placement))
                                                     : to_world,
                      own);
            };
            if (placement.skin >= 0)
                visit_shown(places_.of_node(node), M44d());
            else
                places_.each_with_own(node, visit_shown);
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

    // A primitive with the file's vertices, its values repaired.
    Mesh read_repaired(const std::vector<double>& morph_weights,
                       const tinygltf::Primitive& primitive, uint32_t material_index,
                       GltfTally& tally) const {
        const Material& material = scene_.materials[material_index];
        Mesh mesh = read_primitive(
            gltf_, primitive,
            {morph_weights, material.needs_tangents(), materials_.more_sets(material_index)},
            tally);
        mesh.material = material_index;
        count(repair_values(mesh), tally);
        tally.unmapped_primitives += add_missing_uv(mesh, material);
        tally.replaced_normals += repair_normals(mesh);
        repair_tangents(mesh);
        return mesh;
    }

    // Tangents are found before the mesh is moved, so that every copy of it shades alike.
    SourceMesh read_shaded(const std::vector<double>& morph_weights,
                           const tinygltf::Primitive& primitive, uint32_t material_index) {
        SourceMesh source(read_repaired(morph_weights, primitive, material_index, tally_));
        const Material& material = scene_.materials[material_index];
        if (material.needs_tangents() && source.mesh.tangents.empty()) {
            split_for_tangents(source, material.tangent_slot());
            add_tangents(source.mesh, material.tangent_slot());
            tally_.honoured.insert("tangents computed for normal maps");
        }
        return source;
    }

    // Gives a mesh that read_shaded() made the shape of other morph weights, with its triangles and
    // texture coordinates; false where other triangles are broken then.
    bool reshape(SourceMesh& source, const std::vector<double>& morph_weights,
                 const tinygltf::Primitive& primitive) const {
        GltfTally uncounted;
        Mesh shape = read_repaired(morph_weights, primitive, source.mesh.material, uncounted);
        if (shape.triangles.size() != source.mesh.triangles.size()) return false;
        source.take_shape(std::move(shape));
        const Material& material = scene_.materials[source.mesh.material];
        if (material.needs_tangents() && source.mesh.tangents.empty())
            add_tangents(source.mesh, material.tangent_slot());
        return true;
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
    const NodeMotion& motion_;
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

void place_meshes(const GltfModel& gltf, const GltfNodes& nodes, const NodeMotion& motion,
                  const GltfVariant& variant, GltfMaterials& materials, Scene& scene,
                  GltfTally& tally, std::optional<float> stroke_radius_m) {
    Placer(gltf, nodes, motion, variant, materials, scene, tally, stroke_radius_m).run();
}

}  // namespace petzval::io
