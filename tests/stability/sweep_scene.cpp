// SPDX-License-Identifier: Apache-2.0
// How small, how large and how far away a scene may be.
#include <fmt/format.h>

#include "camera/models/thin_lens.h"
#include "core/sampling/warp.h"
#include "core/shading/surface.h"
#include "tests/stability/sweeps.h"
#include "tests/stability/world.h"

namespace petzval::stability {
namespace {

struct BallFaults {
    double self_hits = 0, leaks = 0;  ///< shares of the rays

    [[nodiscard]] double all() const { return self_hits + leaks; }
};

// Rays from inside a closed convex mesh: each must hit; what leaves the hit outward must hit
// nothing, what leaves it inward must hit another triangle.
BallFaults leave_ball(double radius_m, double away_radii) {
    constexpr int kRays = 1500;
    const auto radius = static_cast<float>(radius_m);
    const V3f centre = V3f(1.f, -0.7f, 0.3f) * static_cast<float>(radius_m * away_radii);
    World world;
    world.place(ball(centre, radius), diffuse(0.5f));
    world.finish();
    Draws draws(17);
    BallFaults out;
    for (int i = 0; i < kRays; ++i) {
        Ray ray;
        ray.origin = centre + uniform_sphere(draws.next2()) * (0.5f * radius * draws.next());
        ray.direction = uniform_sphere(draws.next2());
        const auto hit = world.bvh->intersect(ray);
        if (!hit) {
            out.leaks += 1.0 / kRays;
            continue;
        }
        const Surface s = make_surface(world.scene, ray.direction, *hit);
        V3f away = uniform_sphere(draws.next2());
        if (away.dot(s.ng) < 0) away = -away;
        Ray outward, inward;
        outward.origin = offset_origin(s.p, s.p_error, s.ng, away);
        outward.direction = away;
        inward.origin = offset_origin(s.p, s.p_error, s.ng, -away);
        inward.direction = -away;
        const auto far_side = world.bvh->intersect(inward);
        out.leaks += (far_side ? 0 : 1.0) / kRays;
        const bool again = far_side && far_side->triangle == hit->triangle;
        out.self_hits += (world.bvh->intersect(outward) || again ? 1.0 : 0) / kRays;
    }
    return out;
}

}  // namespace

Finding scene_scale() {
    Finding f{.method = "Scales of scenes", .fails = "leaks"};
    f.sweep =
        "A closed ball of 2208 triangles. Of 1500 rays from within, those that leak, or that hit "
        "the triangle which they just left: over its radius with its middle at the origin, and, "
        "with a radius of 1 m, over the distance of its middle from the origin.";
    f.table.columns = {"radius (m)",   "leaks",       "self-hits",
                       "away (radii)", "leaks there", "self-hits there"};
    for (int k = -8; k <= 8; ++k) {
        const double radius = std::pow(10, 2 * k);
        std::vector<std::string> cells = row(radius, percent(leave_ball(radius, 0).leaks),
                                             percent(leave_ball(radius, 0).self_hits));
        const double away = std::pow(10, k + 1);
        const auto more = k < 0 ? row("", "", "")
                                : row(away, percent(leave_ball(1, away).leaks),
                                      percent(leave_ball(1, away).self_hits));
        cells.insert(cells.end(), more.begin(), more.end());
        f.table.rows.push_back(cells);
    }
    const auto small = first_failure(
        1, 1e-30, [](double r) { return leave_ball(r, 0).all() > 0; }, 1);
    const auto large = first_failure(
        1, 1e30, [](double r) { return leave_ball(r, 0).all() > 0; }, 1);
    const auto away = first_failure(
        1, 1e9, [](double d) { return leave_ball(1, d).all() > 0; }, 2);
    f.where = fmt::format(
        "Below a radius of {} m and above {} m, where squares leave the range of floats; at {} "
        "radii from the origin, where the corners of triangles become one",
        number(small), number(large), number(away));
    f.instead =
        "Rays leave a surface outside of the bound on the rounding of the point, not by a fixed "
        "distance: from 1e-4 to 1e6 m nothing leaks. Beyond the limits above nothing is done.";
    return f;
}

namespace {

// Where camera rays of a pinhole (50 mm over 36 mm and 6000 pixels) find a wall a metre ahead,
// against exact geometry, when all of it stands so far from the origin: in pixels.
double place_error_px(double away_m) {
    const V3f eye = V3f(1.f, -0.7f, 0.3f) * static_cast<float>(away_m);
    World world;
    world.place(quad(eye + V3f(-2, -2, -1), V3f(4, 0, 0), V3f(0, 4, 0)), diffuse(0.5f));
    world.finish();
    const double wall_z = double(world.scene.meshes[0].positions[0].z);
    M44f pose;
    for (int i = 0; i < 3; ++i) pose[3][i] = eye[i];
    const float yfov = 2 * std::atan(12.f / 50.f);
    const camera::ThinLensCamera camera({pose, yfov, 1.5f, {}, 1.f});
    const double pixel_m = 0.006 / 50;
    double worst = 0;
    Draws draws(19);
    for (int i = 0; i < 1000; ++i) {
        const V2f film = draws.next2();
        const Ray ray =
            camera.sample({film, Sampler(SamplerKind::Owen, 1, {0, 0, 0})}, Bands::rgb())[0].ray;
        const auto hit = world.bvh->intersect(ray);
        if (!hit) return HUGE_VAL;
        const V3d p(make_surface(world.scene, ray.direction, *hit).p);
        const double half = std::tan(double(yfov) / 2);
        const V3d toward((2 * double(film.x) - 1) * half * 1.5, (1 - 2 * double(film.y)) * half,
                         -1);
        // A wall that rounding moved is a scene of its own; its picture is asked for.
        const double depth = double(eye.z) - wall_z;
        const V3d exact = V3d(eye) + toward * depth;
        worst = std::fmax(worst, std::hypot(p.x - exact.x, p.y - exact.y) / pixel_m);
    }
    return worst;
}

}  // namespace

Finding camera_far_from_origin() {
    Finding f{.method = "Cameras far from the origin", .fails = "bias"};
    f.sweep =
        "A pinhole (50 mm over 36 mm and 6000 pixels) and a wall 1 m ahead of it, both so far from "
        "the origin: the worst of 1000 points that camera rays find, against exact geometry, in "
        "pixels.";
    f.table.columns = {"distance from the origin (m)", "off (px)"};
    for (int k = 0; k <= 7; ++k) {
        const double away = std::pow(10, k);
        add_row(f, away, place_error_px(away));
    }
    const auto tenth = first_failure(1, 1e8, [](double d) { return place_error_px(d) > 0.1; });
    const auto whole = first_failure(1, 1e8, [](double d) { return place_error_px(d) > 1; });
    f.where = fmt::format(
        "A tenth of a pixel from {} m on, a pixel from {} m on, for what is 1 m ahead; in "
        "proportion later for what is farther ahead",
        number(tenth), number(whole));
    f.instead =
        "Positions are floats in metres, as in glTF: nothing moves a scene to the origin. Matrices "
        "of nodes are multiplied in doubles before they are rounded.";
    return f;
}

}  // namespace petzval::stability
