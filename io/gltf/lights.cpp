// SPDX-License-Identifier: Apache-2.0
#include "io/gltf/lights.h"

#include <tiny_gltf.h>

#include <algorithm>

#include "io/base/json_cursor.h"
#include "io/base/json_parse.h"
#include "io/gltf/animation/thinning.h"
#include "io/gltf/materials/spectral.h"
#include "io/gltf/schema/schema.h"
#include "io/gltf/validate/extras.h"

namespace petzval::io {
namespace {

/// Direction of the node's own -z axis; nothing where a scale of zero leaves none.
std::optional<V3f> forward(const M44d& to_world) {
    const V3d z = row(to_world, 2);
    const double length = std::sqrt(z.dot(z));
    if (!(length > 0) || !std::isfinite(length)) return {};
    return V3f(z / -length);
}

Rgb colour_of(const tinygltf::Light& light) {
    const auto& c = light.color;
    return c.size() == 3 ? Rgb(float(c[0]), float(c[1]), float(c[2])) : Rgb(1.f);
}

std::optional<Light> make_light(const tinygltf::Light& light, const M44d& to_world) {
    const V3f position(row(to_world, 3));
    const Rgb colour = colour_of(light) * static_cast<float>(light.intensity);
    if (light.type == "point") return PointLight{position, colour};
    const std::optional<V3f> direction = forward(to_world);
    if (!direction) return {};
    if (light.type == "directional") return SunLight{*direction, colour};
    if (light.type != "spot") return {};
    const double outer_rad = light.spot.outerConeAngle;
    const double inner_rad = std::min(light.spot.innerConeAngle, outer_rad);
    return SpotLight{position, *direction, colour, static_cast<float>(std::cos(inner_rad)),
                     static_cast<float>(std::cos(outer_rad))};
}

/// Makes a sun a disc where the file gives it an angle.
void widen(Light& light, const JsonCursor& json, GltfTally& tally) {
    const float angle_deg = light_angle_deg(json);
    if (angle_deg == 0.f) return;
    auto* const sun = std::get_if<SunLight>(&light);
    constexpr float least_deg = 0.01f;  // floats hardly tell directions of less apart
    if (!sun) {
        tally.warnings.add(json.path(), "only a directional light has a use for angle_deg");
    } else if (angle_deg < least_deg) {
        tally.warnings.add(json.path(),
                           "its angle_deg is too small for a disc; it is "
                           "rendered as a point of the sky");
    } else {
        const double half_sine = std::sin(double(angle_deg) * double(kPi) / 180 / 4);
        sun->versine = static_cast<float>(2 * half_sine * half_sine);
        sun->unseen = is_unseen(json);
        tally.honoured.insert("suns with an angle, as discs of the sky that can be seen");
    }
}

void set_illuminant(Light& light, int32_t illuminant) {
    const auto set = [&](auto& kind) {
        if constexpr (requires { kind.illuminant; }) kind.illuminant = illuminant;
    };
    std::visit(set, light);
}

// Radius from which on a light is a ball: below, floats cannot tell its points apart, or its
// radiance is beyond them.
bool can_be_ball(const V3f& centre, float radius_m, Rgb intensity_cd) {
    constexpr float least_m = 1e-6f, least_share = 1e-5f, most_nits = 1e30f;
    const V3f away = abs(centre);
    return radius_m >= least_m && radius_m >= least_share * std::max({away.x, away.y, away.z}) &&
           hmax(intensity_cd.v) / (radius_m * radius_m) < most_nits;
}

/// The lamp that a light with a radius is; nothing for one that has none.
std::optional<BallLamp> as_ball(const Light& light, const JsonCursor& json, const std::string& node,
                                GltfTally& tally) {
    const float radius_m = light_radius_m(json).value_or(0.f);
    if (radius_m == 0.f) return {};
    const auto* const point = std::get_if<PointLight>(&light);
    const auto* const spot = std::get_if<SpotLight>(&light);
    if (!point && !spot) {
        tally.warnings.add(json.path(), "a directional light has no use for a radius");
        return {};
    }
    BallLamp lamp;
    const auto take = [&](const auto& from) {
        lamp = {from.position, radius_m, from.intensity_cd, from.illuminant, {}, {}};
    };
    point ? take(*point) : take(*spot);
    if (spot) lamp.beam = Beam{spot->direction, spot->cos_inner, spot->cos_outer};
    lamp.unseen = is_unseen(json);
    if (!can_be_ball(lamp.centre, radius_m, lamp.intensity_cd)) {
        tally.warnings.add(node,
                           "its light's radius is too small for where it stands or "
                           "how bright it is; it is rendered as a point");
        return {};
    }
    ++(point ? tally.point_lamps : tally.spot_lamps);
    tally.honoured.insert("lights with a radius, as balls that can be seen");
    return lamp;
}

// Warns where the beam of a lamp turns while the shutter is open.
void warn_of_turning(const std::vector<M44d>& places, int node, const std::optional<Beam>& beam,
                     GltfTally& tally) {
    constexpr float same = 1e-4f;
    const auto turns = [&](const M44d& place) {
        const auto direction = forward(place);
        return direction && (*direction - beam->direction).length() > same;
    };
    if (beam && std::any_of(places.begin(), places.end(), turns))
        tally.warnings.add(json_path("nodes", node),
                           "its light has a size: while it turns, its beam shines as in "
                           "the middle of the exposure");
}

// Makes a ball move as its node does.
void move_ball(const NodeMotion& motion, int node, BallLamp& lamp, GltfTally& tally) {
    const auto* const places = motion.places(node);
    if (!places) return;
    std::vector<M44d> centres(places->size());
    for (size_t i = 0; i < centres.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) centres[i][3][axis] = (*places)[i][3][axis];
    const double r = lamp.radius_m;
    const Thinning thinning = thin(centres, std::array{V3d(-r), V3d(r)});
    for (size_t i = 0; i < centres.size(); i += thinning.stride)
        lamp.centres.emplace_back(row(centres[i], 3));
    ++tally.moving_lights;
    warn_of_turning(*places, node, lamp.beam, tally);
}

bool is_dark(const tinygltf::Light& light) {
    const auto zero = [](double c) { return c == 0; };
    return light.intensity == 0 ||
           (!light.color.empty() && std::all_of(light.color.begin(), light.color.end(), zero));
}

// Whether a lamp is too small, or too bright for its size, to be more than a point.
bool is_almost_point(const FlatLamp& lamp) {
    const V3f at(row(M44d(lamp.to_world), 3));
    return !can_be_ball(at, std::min(lamp.size_m.x, lamp.size_m.y) / 2, lamp.intensity_cd);
}

/// Rigid matrix: orthonormal axes with the file's -z and, as nearly as can be, its y. Nothing where
/// a scale of zero leaves none.
std::optional<M44f> rigid(const M44d& m) {
    if (is_singular(m)) return {};
    const V3d z = row(m, 2).normalized();
    const V3d x = row(m, 1).cross(z).normalized();
    const V3d y = z.cross(x), p = row(m, 3);
    return M44f(M44d(x.x, x.y, x.z, 0, y.x, y.y, y.z, 0, z.x, z.y, z.z, 0, p.x, p.y, p.z, 1));
}

// Makes a flat lamp move as its node does.
void move_flat(const NodeMotion& motion, int node, FlatLamp& lamp, GltfTally& tally) {
    const auto* const places = motion.places(node);
    if (!places) return;
    std::vector<M44d> steps;
    for (const M44d& place : *places) steps.emplace_back(rigid(place).value_or(lamp.to_world));
    const V3d half(double(lamp.size_m.x) / 2, double(lamp.size_m.y) / 2, 0);
    const Thinning thinning =
        thin(steps, std::array{half, -half, V3d(half.x, -half.y, 0), V3d(-half.x, half.y, 0)});
    for (size_t i = 0; i < steps.size(); i += thinning.stride) lamp.steps.emplace_back(steps[i]);
    ++tally.moving_lights;
    warn_of_turning(*places, node, lamp.beam, tally);
}

GltfCamera to_camera(const JsonCursor& from, const M44f& to_world) {
    const auto number = [&](CameraRow name) {
        return static_cast<float>(std::fabs(number_of(from, name)));
    };
    GltfCamera camera;
    camera.to_world = to_world;
    const std::string type = from.text("type");
    camera.orthographic = type == "orthographic";
    if (camera.orthographic) {
        camera.xmag_m = number("xmag");
        camera.ymag_m = number("ymag");
    } else if (type == "perspective") {
        camera.yfov_rad = number("yfov");
        if (const float aspect = number("aspectRatio"); aspect > 0) camera.aspect = aspect;
    }
    return camera;
}

/// Whether a camera has a field of view, which lies from 0 to pi; cameras of unknown type have
/// none.
bool is_usable(const GltfCamera& camera) {
    return camera.orthographic || (camera.yfov_rad > 0 && camera.yfov_rad < kPi);
}

// Gives a camera whose view changes while the shutter is open that view at few time steps: the
// height of the picture is followed within a thousandth.
void zoom(const NodeMotion& motion, int number, GltfCamera& camera, GltfTally& tally) {
    const char* const kind = camera.orthographic ? "orthographic" : "perspective";
    const std::string place = json_path("cameras", number);
    const auto* const values =
        motion.of_camera(place + "/" + kind + (camera.orthographic ? "/ymag" : "/yfov"));
    if (!values || !is_usable(camera)) return;
    std::vector<std::vector<double>> heights;  // of what is seen at a distance of 1, or everywhere
    double most = 0;
    for (const double value : *values) {
        if (!camera.orthographic && !(value > 0 && value < double(kPi))) {
            tally.warnings.add(place,
                               "its yfov leaves 0 to 180 degrees while the shutter is "
                               "open; it stays as in the middle of the exposure");
            tally.held.insert("views of cameras");
            return;
        }
        heights.push_back({camera.orthographic ? std::fabs(value) : std::tan(value / 2)});
        most = std::max(most, heights.back()[0]);
    }
    const Thinning thinning = thin(heights, std::array{1.}, most);
    for (size_t i = 0; i < values->size(); i += thinning.stride)
        camera.zoom.push_back(static_cast<float>(std::fabs((*values)[i])));
    ++tally.zooming_cameras;
}

// The light of a node that has an area: what the node says of it goes before what its light says.
FlatLamp flat_lamp(const GltfModel& gltf, const JsonCursor& node, const AreaExtras& area,
                   const M44d& to_world, GltfSpectral& spectral) {
    FlatLamp lamp;
    lamp.size_m = area.size_m;
    lamp.ellipse = area.ellipse;
    lamp.unseen = is_unseen(node);
    Rgb color(1.f);
    float intensity_cd = 0;
    const JsonCursor root(gltf.source.json, gltf.file);
    if (const auto extension = node.extension("KHR_lights_punctual")) {
        const auto lights = root.extension("KHR_lights_punctual")->objects("lights");
        const size_t number = extension->required_index("light", lights.size(), "light");
        const tinygltf::Light& light = gltf.typed.lights.at(number);
        if (light.type == "directional")
            node.fail(
                "has an area and a directional light, which has none; give the light an "
                "\"angle_deg\" in its extras.petzval");
        color = colour_of(light);
        intensity_cd = static_cast<float>(light.intensity);
        lamp.illuminant = spectral.illuminant(lights[number]);
        lamp.unseen |= is_unseen(lights[number]);
        const auto made = make_light(light, to_world);
        if (const auto* spot = made ? std::get_if<SpotLight>(&*made) : nullptr)
            lamp.beam = Beam{spot->direction, spot->cos_inner, spot->cos_outer};
    }
    if (area.color) color = {area.color->x, area.color->y, area.color->z};
    lamp.intensity_cd = color * area.intensity_cd.value_or(intensity_cd);
    if (const int32_t own = spectral.illuminant(node); own >= 0) lamp.illuminant = own;
    return lamp;
}

}  // namespace

void move_last_light(const NodeMotion& motion, int node, Scene& scene, GltfTally& tally,
                     const std::function<std::optional<Light>(const M44d&)>& make) {
    const auto* const places = motion.places(node);
    if (!places) return;
    std::vector<Light> steps;
    for (const M44d& place : *places) {
        auto made = make(place);
        steps.push_back(made ? *std::move(made) : scene.lights.back());
    }
    scene.light_motion_of.resize(scene.lights.size(), -1);
    scene.light_motion_of.back() = static_cast<int32_t>(scene.light_motions.size());
    scene.light_motions.push_back(std::move(steps));
    ++tally.moving_lights;
}

std::vector<FlatLamp> read_flat_lamps(const GltfModel& gltf, const GltfNodes& nodes,
                                      const NodeMotion& motion, Scene& scene, GltfTally& tally) {
    std::vector<FlatLamp> lamps;
    const auto& json = member(gltf.source.json, "nodes");
    GltfSpectral spectral(scene, tally);
    for (int number : nodes.in_scene) {
        const auto index = static_cast<size_t>(number);
        if (!json[index].contains("extras")) continue;
        const JsonCursor node(json[index], gltf.file, json_path("nodes", number));
        const auto area = area_extras(node);
        if (!area) continue;
        FlatLamp lamp = flat_lamp(gltf, node, *area, nodes.to_world[index], spectral);
        if (!(hmax(lamp.intensity_cd.v) > 0)) continue;
        const auto place = rigid(nodes.to_world[index]);
        if (place) lamp.to_world = *place;
        if (!place || is_almost_point(lamp)) {
            tally.warnings.add(node.path(),
                               "its area lamp is left out, as it is too small for where "
                               "it stands or how bright it is, or scaled to nothing");
            continue;
        }
        move_flat(motion, number, lamp, tally);
        ++tally.flat_lamps;
        tally.honoured.insert("nodes with an area, as flat lamps that can be seen");
        lamps.push_back(std::move(lamp));
    }
    return lamps;
}

std::vector<BallLamp> read_lights(const GltfModel& gltf, const GltfNodes& nodes,
                                  const NodeMotion& motion, Scene& scene, GltfTally& tally) {
    std::vector<BallLamp> lamps;
    const JsonCursor root(gltf.source.json, gltf.file);
    const auto definitions = root.extension("KHR_lights_punctual");
    if (!definitions) return lamps;
    const auto lights = definitions->objects("lights"), json = root.objects("nodes");
    GltfSpectral spectral(scene, tally);
    for (int node : nodes.in_scene) {
        const auto index = static_cast<size_t>(node);
        const auto extension = json[index].extension("KHR_lights_punctual");
        if (!extension) continue;
        const size_t number = extension->required_index("light", lights.size(), "light");
        const tinygltf::Light& light = gltf.typed.lights.at(number);
        if (is_dark(light) || area_extras(json[index])) continue;  // flat lamps are read apart
        if (auto made = make_light(light, nodes.to_world[index])) {
            tally.ranged_lights += light.range > 0;
            const int32_t illuminant = spectral.illuminant(lights[number]);
            set_illuminant(*made, illuminant);
            widen(*made, lights[number], tally);
            if (auto lamp = as_ball(*made, lights[number], json_path("nodes", node), tally)) {
                move_ball(motion, node, *lamp, tally);
                lamps.push_back(*std::move(lamp));
            } else {
                scene.lights.push_back(*made);
                move_last_light(motion, node, scene, tally, [&](const M44d& place) {
                    auto step = make_light(light, place);
                    auto* const sun = step ? std::get_if<SunLight>(&*step) : nullptr;
                    if (sun) sun->versine = std::get<SunLight>(*made).versine;
                    if (sun) sun->unseen = std::get<SunLight>(*made).unseen;
                    if (step) set_illuminant(*step, illuminant);
                    return step;
                });
            }
        } else {
            tally.warnings.add(json_path("nodes", node), "its light is left out");
        }
    }
    return lamps;
}

std::vector<GltfCamera> read_cameras(const GltfModel& gltf, const GltfNodes& nodes,
                                     const NodeMotion& motion, GltfTally& tally) {
    std::vector<GltfCamera> cameras;
    const JsonCursor root(gltf.source.json, gltf.file);
    const auto json = root.objects("cameras");
    for (int index : nodes.all_in_scene) {
        const GltfNode& node = nodes.node[static_cast<size_t>(index)];
        if (node.camera < 0) continue;
        const auto to_world = rigid(nodes.to_world[static_cast<size_t>(index)]);
        if (!to_world) {
            ++tally.singular_nodes;
            continue;
        }
        const JsonCursor& from = json[static_cast<size_t>(node.camera)];
        GltfCamera camera = to_camera(from, *to_world);
        if (const auto* const places = motion.places(index)) {
            for (const M44d& place : *places)
                camera.steps.push_back(rigid(place).value_or(*to_world));
            ++tally.moving_cameras;
        }
        camera.name = from.text_or("name", "");
        if (camera.name.empty())
            camera.name = text_of(root.value()["nodes"][static_cast<size_t>(index)], "name");
        camera.extras = camera_extras(from);
        if (camera.orthographic && camera.extras.any())
            tally.warnings.push_back(json_path("cameras", node.camera) +
                                     "/extras/petzval: an orthographic camera has no use for it");
        if (camera.extras.lens) tally.honoured.insert("lens " + *camera.extras.lens);
        zoom(motion, node.camera, camera, tally);
        if (is_usable(camera))
            cameras.push_back(camera);
        else
            tally.warnings.add(json_path("cameras", node.camera),
                               "left out, as its view cannot be drawn");
    }
    return cameras;
}

}  // namespace petzval::io
