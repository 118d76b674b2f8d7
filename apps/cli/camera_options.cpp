// SPDX-License-Identifier: Apache-2.0
#include "apps/cli/camera_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "apps/cli/choice.h"
#include "apps/cli/parse.h"
#include "apps/setup/option_names.h"
#include "io/base/ascii.h"

namespace petzval {
namespace {

// Bounds that keep every product of two lengths a float; no real lens or place comes near.
constexpr double kLeast = 1e-6, kMost = 1e6;
constexpr float kFarthest_m = 1e12f, kNearest_m = 1e-12f;

void add_place_options(CLI::App& app, CameraOptions& o) {
    CameraRequest& r = o.request;
    const auto length_mm = number_between(kLeast, kMost, kMillimetres);
    const auto add = [&](const char* name, auto& value, const char* help) {
        return app.add_option(name, value, help)->group("Camera");
    };
    add("--camera", r.name, "camera of the file, by name or index");
    add("--look-at", o.look_at, "ex,ey,ez,tx,ty,tz: eye and target in metres");
    add("--orbit", r.orbit_deg,
        "turn the camera about the scene: degrees, counter-clockwise from above")
        ->transform(number_between(-kMost, kMost, kDegrees));
    add("--orbit-about", o.orbit_about,
        "x,y,z: about the vertical axis there (default: through the target of --look-at, else "
        "the middle of the scene)");
    add("--fov", r.fov_deg, "vertical angle of view in degrees")
        ->transform(number_between(kSmallestFov_deg, kLargestFov_deg, kDegrees));
    add("--sensor", o.sensor,
        "WxH in mm, cropped to the picture's aspect (default 36x24, or what a lens covers of it)");
    add("--focus", o.focus,
        "sharp plane: its distance from the entrance pupil (1.5m, 30cm, 5ft; 1.5 is metres), "
        "infinity, the pixel x,y, or auto");
    auto* fstop = add("--fstop", r.fstop,
                      "f-number of the lens: its iris, as 2 or f/2; traced: 1 / (2 sin u') of a "
                      "distant point, "
                      "others: focal length / diameter")
                      ->transform(fnumber_between(kLeast, kMost));
    add("--lens-radius", r.lens_radius_m, "of a thin lens, in metres")
        ->transform(number_between(kLeast, kMost, kMetres))
        ->excludes(fstop);
    add("--focal-length", r.focal_length_mm,
        "of a thin lens, in mm; without --fov it sets the angle of view too")
        ->transform(length_mm);
    add("--film-distance", r.film_distance_mm,
        "from a thin lens, in mm: gives --focus, or with it the focal length")
        ->transform(length_mm);
}

void add_lens_options(CLI::App& app, CameraOptions& o) {
    CameraRequest& r = o.request;
    const auto group = [](CLI::Option* option) { return option->group("Lens"); };
    group(app.add_option("--lens", r.lens,
                         "pinhole, thin, singlet:GLASS[,BENDING], singlet:GLASS,R1_MM,R2_MM, a "
                         "lens that ships (petzval lens list) or FILE.json, .dat, .zmx"))
        ->check([](const std::string& text) {
            return quantity(text, kMillimetres)
                       ? fmt::format("\"{0}\" is a length; type --lens thin --focal-length {0}",
                                     text)
                       : "";
        });
    group(app.add_option("--glasses", r.glasses,
                         "catalogue of glasses, .agf, that goes before those that ship; may be "
                         "given more than once"))
        ->allow_extra_args(false);
    group(add_choice<FocusBy>(app, "--focus-by", r.focus_by,
                              "paraxial (default): rays near the axis; traced: the smallest spot "
                              "on the axis through the iris that is set"));
    group(add_choice<Fit>(app, "--fit", r.fit,
                          "lens (default): the lens gives the angle of view; fov: it is scaled "
                          "to that of the camera or --fov"));
    group(app.add_option("--aperture", r.aperture,
                         "shape of the iris: circle (default), square, triangle, rhomboid, frame, "
                         "star:N, polygon:N[,ROTATION_DEG[,ROUNDNESS]], FILE.svg, FILE.png"))
        ->check([](std::string text) {
            const std::string complaint = fnumber_between(kLeast, kMost)(text);
            return complaint.empty()
                       ? fmt::format("{0} is an f-number and no shape; type --fstop {0}", text)
                       : "";
        });
    group(add_choice<ApertureScale>(
        app, "--aperture-scale", r.aperture_scale,
        "area (default): the round stop's area; inscribed: inside the round stop"));
    group(add_choice<IrisSampling>(
        app, "--iris-sampling", r.iris_sampling,
        "formula, rejection, triangles, alias (default: the best that the shape has)"));
    Choices<std::optional<DispersionMode>> modes{{"auto", std::nullopt}};
    for (const auto& [name, mode] : kOptionNames<DispersionMode>) modes.emplace_back(name, mode);
    group(add_choice<std::optional<DispersionMode>>(
        app, "--dispersion", r.dispersion, modes,
        "wavelengths that leave the lens apart: auto (default: as a test render finds, "
        "docs/guide/plan.md; in charts as hero), shared, hero, split"));
}

void add_glass_options(CLI::App& app, CameraOptions& o) {
    CameraRequest& r = o.request;
    const auto group = [](CLI::Option* option) { return option->group("Lens"); };
    group(add_choice<Coating>(app, "--coating", r.coating,
                              "light lost at each surface: ideal (default, none), uncoated, mgf2 "
                              "(one layer against air)"));
    group(add_choice<Precision>(app, "--lens-precision", r.precision,
                                "rays through the lens in float (default) or double"));
}

void add_exposure_options(CLI::App& app, CameraOptions& o) {
    CameraRequest& r = o.request;
    const auto group = [](CLI::Option* option) { return option->group("Lens"); };
    auto* mode = group(add_choice<ExposureMode>(
        app, "--exposure-mode", r.exposure,
        "normalised (default): as bright at every f-number; photographic: by --iso, --shutter and "
        "the iris"));
    group(add_choice<std::optional<bool>>(
        app, "--natural-vignetting", r.natural_vignetting,
        Choices<std::optional<bool>>{{"auto", std::nullopt}, {"on", true}, {"off", false}},
        "light falls towards the corners of a pinhole, thin lens or singlet by cos^4 of its angle "
        "on the film: auto (default: with photographic exposure), on, off; a traced lens has its "
        "own"));
    group(app.add_option("--iso", r.iso, "speed of the film (default 100)"))
        ->transform(number_between(1e-3, 1e9))
        ->needs(mode);
    auto* shutter = group(app.add_option(
        "--shutter", o.shutter,
        "seconds or degrees: 0.01 or 1/100 (default), 180deg of a frame of --fps; with --at, what "
        "moves meanwhile is blurred"));
    group(app.add_option("--shutter-curve", o.shutter_curve,
                         "how it opens and closes: box (default, at once), trapezoid, or a CSV "
                         "file of time and openness"))
        ->needs(shutter);
}

std::array<V3f, 2> parse_look_at(const std::string& text) {
    const auto v = parse_lengths_m("--look-at", text, 6);
    for (const float x : v)
        if (std::fabs(x) > kFarthest_m)
            throw CLI::ValidationError("--look-at", fmt::format("{:g} m is too far away", x));
    const std::array<V3f, 2> aim{V3f(v[0], v[1], v[2]), V3f(v[3], v[4], v[5])};
    if ((aim[0] - aim[1]).length() < kNearest_m)
        throw CLI::ValidationError("--look-at", "eye and target are the same point");
    return aim;
}

}  // namespace

void add_camera_options(CLI::App& app, CameraOptions& o) {
    add_place_options(app, o);
    add_lens_options(app, o);
    add_glass_options(app, o);
    add_exposure_options(app, o);
}

CameraRequest resolve(CameraOptions& o, V2i frame, const TimeOptions& time) {
    CameraRequest& r = o.request;
    for (const char* word : {"pinhole", "thin"})
        if (r.lens && lower(*r.lens) == word) r.lens = word;
    if (!o.look_at.empty()) {
        r.look_at = parse_look_at(o.look_at);
        if (r.name) throw CLI::ValidationError("--look-at", "excludes --camera");
    }
    if (!o.orbit_about.empty()) {
        if (!r.orbit_deg)
            throw CLI::ValidationError("--orbit-about",
                                       "has no effect but with --orbit or --turntable");
        const auto at_m = parse_lengths_m("--orbit-about", o.orbit_about, 3);
        r.orbit_about = V3f(at_m[0], at_m[1], at_m[2]);
    }
    if (!o.sensor.empty()) r.sensor_mm = parse_sensor("--sensor", o.sensor, kLeast, kMost);
    if (!o.focus.empty()) r.focus = parse_focus("--focus", o.focus, frame);
    if (!o.shutter.empty()) {
        r.shutter_s = parse_shutter_s("--shutter", o.shutter, time.fps);
        if (time.plays()) r.shutter_curve = parse_shutter_curve("--shutter-curve", o.shutter_curve);
    }
    if (r.exposure != ExposureMode::Photographic) {
        if (r.iso != CameraRequest().iso)
            throw CLI::ValidationError("--exposure-mode",
                                       "--iso has no effect but with photographic");
        if (!o.shutter.empty() && !time.plays())
            throw CLI::ValidationError(
                "--shutter", "has no effect but with --at, or with --exposure-mode photographic");
    }
    return r;
}

}  // namespace petzval
