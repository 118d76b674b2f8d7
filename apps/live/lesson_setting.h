// SPDX-License-Identifier: Apache-2.0
// What lessons are made of: the settings of their picture, plots and figures.
#pragma once

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/setup/camera/camera_model.h"
#include "camera/bench/aimed_bundle.h"
#include "camera/models/thin_lens_optics.h"
#include "camera/setup/lens_bench.h"
#include "io/base/error.h"

namespace petzval::apps {

inline constexpr double kUm_per_mm = 1000;

/// As lesson_facts() returns it.
using LessonJson = nlohmann::json;

/// A number with so few digits as a plot shows.
[[nodiscard]] inline double rounded(double value) {
    constexpr double kSteps = 1e5;
    return std::round(value * kSteps) / kSteps;
}

/// Curves of one kind: each path is a list of [x, y]. style: a class of the page; those that begin
/// with "dots" are points.
[[nodiscard]] inline LessonJson series(const std::string& name, const char* style,
                                       LessonJson paths) {
    return {{"name", name}, {"style", style}, {"paths", std::move(paths)}};
}

/// An upright line of a plot.
[[nodiscard]] inline LessonJson upright(const char* name, double x, double high) {
    return series(name, "limit", {{{x, -high}, {x, high}}});
}

/// What lesson_facts() returns, as it grows.
class LessonPlots {
  public:
    struct Axis {
        double from, to;
        const char* what;
    };

    /// square: a length is the same along both axes.
    void add(const std::string& title, Axis x, Axis y, LessonJson all, bool square = false) {
        json_["plots"].push_back({{"title", title},
                                  {"x", {x.from, x.to, x.what}},
                                  {"y", {y.from, y.to, y.what}},
                                  {"series", std::move(all)},
                                  {"square", square}});
    }
    void add_figure(const std::string& name, const std::string& text) {
        json_["figures"].push_back({name, text});
    }
    [[nodiscard]] LessonJson json() const { return json_; }

  private:
    LessonJson json_{{"plots", LessonJson::array()}, {"figures", LessonJson::array()}};
};

/// Settings of a lesson. Throws ValueError, with the field, where the lesson lacks one, and
/// InputError where a lens is none for it.
class LessonSetting {
  public:
    explicit LessonSetting(const CameraRequest&);

    [[nodiscard]] const CameraRequest& asked() const { return model_.asked; }
    [[nodiscard]] double focus_mm() const;
    [[nodiscard]] double fstop() const;
    [[nodiscard]] io::ArgumentError refusal(const std::string& why) const;

    /// The traced lens, in focus. stopped: with a round iris of the f-number, else wide open.
    [[nodiscard]] camera::LensBench bench(bool stopped = true) const;
    [[nodiscard]] camera::LensBench in_focus(const camera::Lens&) const;
    /// Rays from a distance that land so far from the middle of the film, towards +x; from the axis
    /// in the section of y.
    [[nodiscard]] camera::AimedBundle rays(const camera::LensBench&, double height_mm,
                                           double distance_mm, double nm = kLineD_nm) const;
    [[nodiscard]] camera::Singlet singlet() const;

  private:
    CameraModel model_;
};

/// Rays of a bundle about the film, for a series: [mm behind it, height].
[[nodiscard]] LessonJson rays_about_film(const camera::LensBench&, const camera::AimedBundle&,
                                         int count, double behind_mm);

/// Circle of confusion, depth of field, shaped bokeh, aberrations over the field: of a traced lens.
[[nodiscard]] LessonJson confusion_lesson(const LessonSetting&);
[[nodiscard]] LessonJson depth_lesson(const LessonSetting&);
[[nodiscard]] LessonJson bokeh_lesson(const LessonSetting&);
[[nodiscard]] LessonJson edge_lesson(const LessonSetting&);
/// Spherical and chromatic aberration of a singlet.
[[nodiscard]] LessonJson spherical_lesson(const LessonSetting&);
[[nodiscard]] LessonJson chromatic_lesson(const LessonSetting&);
/// The plane of focus of a thin lens; points of a triangle.
[[nodiscard]] LessonJson plane_lesson(const LessonSetting&);
[[nodiscard]] LessonJson triangle_lesson(const LessonSetting&);

}  // namespace petzval::apps
