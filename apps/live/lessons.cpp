// SPDX-License-Identifier: Apache-2.0
#include "apps/live/lessons.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <random>

#include "apps/live/lesson_setting.h"
#include "apps/request/value_error.h"
#include "camera/models/thin_lens.h"
#include "core/sampling/warp.h"

namespace petzval::apps {

LessonJson triangle_lesson(const LessonSetting&) {
    constexpr int kPoints = 10000;
    constexpr uint32_t kSeed = 1;
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<float> uniform(0, 1);
    const std::vector<V2d> corner = camera::regular_polygon(camera::kMinBlades).contours[0];
    LessonPlots out;
    LessonJson wrong = LessonJson::array(), right = LessonJson::array();
    std::array<int, 2> near_corner{};
    const auto add = [&](LessonJson& points, V2f weights, int& near) {
        const double b = double(weights.x), c = double(weights.y);
        const V2d p = (1 - b - c) * corner[0] + b * corner[1] + c * corner[2];
        points.push_back({rounded(p.x), rounded(p.y)});
        near += b + c < 0.5;
    };
    for (int i = 0; i < kPoints; ++i) {
        const V2f u(uniform(random), uniform(random));
        add(wrong, {u.x * (1 - u.y), u.x * u.y}, near_corner[0]);
        add(right, uniform_triangle(u), near_corner[1]);
    }
    out.add("Without the square root", {-1, 1, ""}, {-1, 1, ""},
            {series("", "dots fine false", {wrong})}, true);
    out.add("With it, as Petzval draws", {-1, 1, ""}, {-1, 1, ""},
            {series("", "dots fine", {right})}, true);
    for (size_t i = 0; i < 2; ++i)
        out.add_figure(i == 0 ? "wrong" : "right",
                       fmt::format("{:.1f} % of the points in the quarter at the upper corner",
                                   100. * near_corner[i] / kPoints));
    return out.json();
}

LessonJson plane_lesson(const LessonSetting& set) {
    const double focus_m = set.focus_mm() / 1000;
    if (!std::isfinite(focus_m)) throw ValueError("⟨focus⟩", "must be finite here");
    const float half_rad = set.asked().fov_deg.value_or(40.f) * kPi / 360;
    constexpr float kAspect = 1.5f, kStop_mm = 5;
    const camera::ThinLensCamera camera({.to_world = M44f(),
                                         .yfov_rad = 2 * half_rad,
                                         .aspect = kAspect,
                                         .iris = camera::Iris(camera::Disk{}, kStop_mm),
                                         .focus_m = float(focus_m)});
    LessonJson sharp = LessonJson::array(), sphere = LessonJson::array();
    double widest_rad = 0;
    for (int i = 0; i <= 12; ++i) {
        camera::FilmPoint at;
        at.film = {float(i) / 12 * 0.999f, 0.5f};
        std::array<Ray, 2> rays;
        for (size_t k = 0; k < 2; ++k) {
            const camera::CameraSample one =
                camera.through(at, {k == 0 ? -kStop_mm : kStop_mm, 0}, Bands::rgb());
            if (one.empty()) throw set.refusal("lets no light through");
            rays[k] = one[0].ray;
        }
        // Where the two rays of a film point meet, in the plane y = 0.
        const V3f apart = rays[1].origin - rays[0].origin, d0 = rays[0].direction,
                  d1 = rays[1].direction;
        const double along =
            double(apart.x * d1.z - apart.z * d1.x) / double(d0.x * d1.z - d0.z * d1.x);
        const V3f meet = rays[0].origin + d0 * float(along);
        sharp.push_back({rounded(double(meet.x)), rounded(double(-meet.z))});
        const double angle = std::atan2(double(meet.x), double(-meet.z));
        sphere.push_back({focus_m * std::sin(angle), focus_m * std::cos(angle)});
        widest_rad = std::max(widest_rad, std::fabs(angle));
    }
    const double side = focus_m * std::tan(widest_rad) * 1.1;
    LessonPlots out;
    out.add("From above: what is sharp", {-side, side, "m to the side"},
            {0, 1.15 * focus_m, "m ahead"},
            {series("camera's rays meet", "dots", {sharp}), series("a sphere", "false", {sphere}),
             series("edges of the picture", "limit",
                    {{{-side, side / std::tan(widest_rad)},
                      {0, 0},
                      {side, side / std::tan(widest_rad)}}})});
    out.add_figure("edge of the picture",
                   fmt::format("{:.1f}° from the axis", 180 / double(kPi) * widest_rad));
    out.add_figure(
        "the sphere there",
        fmt::format("{:.0f} cm before the plane, {:.0f} % of the distance",
                    100 * focus_m * (1 - std::cos(widest_rad)), 100 * (1 - std::cos(widest_rad))));
    return out.json();
}

nlohmann::json lesson_facts(const std::string& lesson, const RenderOrder& order) {
    const LessonSetting set(order.render.scene.camera);
    const std::map<std::string, LessonJson (*)(const LessonSetting&)> all{
        {"bokeh", bokeh_lesson}, {"confusion", confusion_lesson}, {"depth", depth_lesson},
        {"edge", edge_lesson},   {"spherical", spherical_lesson}, {"chromatic", chromatic_lesson},
        {"plane", plane_lesson}, {"triangle", triangle_lesson}};
    const auto found = all.find(lesson);
    if (found == all.end()) throw ValueError("lesson", "there is none of that name");
    return found->second(set);
}

}  // namespace petzval::apps
