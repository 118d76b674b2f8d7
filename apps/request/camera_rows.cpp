// SPDX-License-Identifier: Apache-2.0
#include "apps/request/field_kinds.h"
#include "apps/request/field_members.h"
#include "apps/request/field_rows.h"
#include "apps/request/parse.h"
#include "io/base/ascii.h"

namespace petzval::apps {
namespace {

// Bounds that keep every product of two lengths a float; no real lens or place comes near.
constexpr double kLeast = 1e-6, kMost = 1e6;
constexpr NumberRange kFNumbers{kLeast, kMost}, kLengths_mm{kLeast, kMost, kMillimetres};

std::string text_of(const V3f& v) {
    return fmt::format("{},{},{}", v.x, v.y, v.z);
}

std::string text_of(const Focus& focus) {
    if (const auto* pixel = std::get_if<FocusPixel>(&focus))
        return fmt::format("{},{}", pixel->x, pixel->y);
    if (const auto* distance = std::get_if<FocusDistance>(&focus)) return focus_text(*distance);
    return "auto";
}

V3f parse_point(const std::string& option, const std::string& text) {
    const auto at_m = parse_lengths_m(option, text, 3);
    return {at_m[0], at_m[1], at_m[2]};
}

std::vector<RequestField> place_fields() {
    return {
        common(text("camera", in::camera(&CameraRequest::name),
                    "camera of the file, by name or index")),
        common(parsed(
            "look-at", in::camera(&CameraRequest::look_at),
            "ex,ey,ez,tx,ty,tz: eye and target in metres", parse_look_at,
            [](const std::array<V3f, 2>& aim) { return text_of(aim[0]) + "," + text_of(aim[1]); })),
        parsed("pose", in::camera(&CameraRequest::pose),
               "12 numbers, the rows of a 3x4 matrix to the world in metres: its columns point "
               "right, up and back, and to the eye; with ⟨camera⟩ that camera stands there",
               parse_pose, text_of_pose),
        number("orbit", in::camera(&CameraRequest::orbit_deg), {-kMost, kMost, kDegrees},
               "turn the camera about the scene: degrees, counter-clockwise from above"),
        method(parsed(
            "orbit-about", in::camera(&CameraRequest::orbit_about),
            "x,y,z: about the vertical axis there (default: through the target of ⟨look-at⟩, "
            "else the middle of the scene)",
            parse_point, [](const V3f& at) { return text_of(at); })),
        common(number("fov", in::camera(&CameraRequest::fov_deg),
                      {kSmallestFov_deg, kLargestFov_deg, kDegrees},
                      "vertical angle of view in degrees")),
        with_between(
            parsed(
                "sensor", in::camera(&CameraRequest::sensor_mm),
                "WxH in mm, cropped to the picture's aspect (default 36x24, or what a lens covers "
                "of it)",
                [](const std::string& option, const std::string& text) {
                    return parse_sensor(option, text, kLeast, kMost);
                },
                [](const V2f& mm) { return fmt::format("{}x{}", mm.x, mm.y); }),
            'x'),
        common(parsed("focus", in::camera(&CameraRequest::focus),
                      "sharp plane: its distance from the entrance pupil (1.5m, 30cm, 5ft; 1.5 is "
                      "metres), infinity, the pixel x,y, or auto",
                      parse_focus, [](const Focus& focus) { return text_of(focus); })),
        common(parsed(
            "fstop", in::camera(&CameraRequest::fstop),
            "f-number of the lens: its iris, as 2 or f/2; traced: 1 / (2 sin u') of a distant "
            "point, others: focal length / diameter",
            [](const std::string& option, const std::string& text) {
                return static_cast<float>(parse_fnumber(option, text, kFNumbers));
            },
            [](float n) { return fmt::format("{}", n); })),
        method(number("lens-radius", in::camera(&CameraRequest::lens_radius_m),
                      {kLeast, kMost, kMetres}, "of a thin lens, in metres")),
        number("focal-length", in::camera(&CameraRequest::focal_length_mm), kLengths_mm,
               "of a thin lens, in mm; without ⟨fov⟩ it sets the angle of view too"),
        method(number("film-distance", in::camera(&CameraRequest::film_distance_mm), kLengths_mm,
                      "from a thin lens, in mm: gives ⟨focus⟩, or with it the focal length"))};
}

std::string parse_lens(const std::string& option, const std::string& text) {
    if (quantity(text, kMillimetres))
        throw ValueError(
            option, fmt::format("\"{0}\" is a length; type ⟨lens⟩ thin ⟨focal-length⟩ {0}", text));
    for (const char* word : {"pinhole", "thin"})
        if (io::lower(text) == word) return word;
    return text;
}

std::string complaint_about_iris(const std::string& text) {
    try {
        return fmt::format("{0} is an f-number and no shape; type ⟨fstop⟩ {0}",
                           parse_fnumber("", text, kFNumbers));
    } catch (const ValueError&) {
        return "";
    }
}

std::vector<RequestField> lens_fields() {
    return {
        common(
            parsed("lens", in::camera(&CameraRequest::lens),
                   "pinhole, thin, singlet:GLASS[,BENDING], singlet:GLASS,R1_MM,R2_MM, a lens that "
                   "ships (petzval lens list) or FILE.json, .dat, .zmx",
                   parse_lens, [](const std::string& lens) { return lens; })),
        list("glasses", in::camera(&CameraRequest::glasses),
             "catalogue of glasses, .agf, that goes before those that ship; may be given more than "
             "once",
             [](const std::string&) { return std::string(); }),
        method(
            choice("focus-by", in::camera(&CameraRequest::focus_by),
                   "paraxial (default): rays near the axis; traced: the smallest spot on the axis "
                   "through the iris that is set")),
        method(choice(
            "fit", in::camera(&CameraRequest::fit),
            "lens (default): the lens gives the angle of view; fov: it is scaled to that of the "
            "camera or ⟨fov⟩")),
        common(
            text("aperture", in::camera(&CameraRequest::aperture),
                 "shape of the iris: circle (default), square, triangle, rhomboid, frame, star:N, "
                 "polygon:N[,ROTATION_DEG[,ROUNDNESS]], FILE.svg, FILE.png",
                 complaint_about_iris)),
        method(choice("aperture-scale", in::camera(&CameraRequest::aperture_scale),
                      "area (default): the round stop's area; inscribed: inside the round stop")),
        method(
            choice("iris-sampling", in::camera(&CameraRequest::iris_sampling),
                   "formula, rejection, triangles, alias (default: the best that the shape has)")),
        method(
            choice("dispersion", in::camera(&CameraRequest::dispersion),
                   "wavelengths that leave the lens apart: auto (default: as a test render finds, "
                   "docs/guide/plan.md; in charts as hero), shared, hero, split",
                   "auto")),
        method(choice(
            "coating", in::camera(&CameraRequest::coating),
            "light lost at each surface: ideal (default, none), uncoated, against air "
            "mgf2 (one layer), v-coat (two), broadband (three), as filed with the lens, or the "
            "usual one of its year")),
        choice(
            "ghosts", in::camera(&CameraRequest::ghosts),
            "light that two surfaces of a traced lens reflect: auto (default; where the ⟨coating⟩ "
            "reflects any), off, only"),
        choice("diffraction", in::camera(&CameraRequest::diffraction),
               "light that the iris spreads: off (default), auto (where it changes the picture)"),
        method(choice("lens-precision", in::camera(&CameraRequest::precision),
                      "rays through the lens in float (default) or double"))};
}

std::optional<bool> parse_vignetting(const std::string& option, const std::string& text) {
    return parse_choice<std::optional<bool>>(
        option, text, {{"auto", std::nullopt}, {"on", true}, {"off", false}});
}

std::string text_of(ShutterTime time) {
    return time.is_angle ? fmt::format("{}deg", time.value)
                         : fmt::format("{}", static_cast<float>(time.value));
}

std::vector<RequestField> exposure_fields() {
    return {
        choice("exposure-mode", in::camera(&CameraRequest::exposure),
               "normalised (default): as bright at every f-number; photographic: by ⟨iso⟩, "
               "⟨shutter⟩ and the iris"),
        method(parsed(
            "natural-vignetting", in::camera(&CameraRequest::natural_vignetting),
            "light falls towards the corners of a pinhole, thin lens or singlet by cos^4 of its "
            "angle on the film: auto (default: with photographic exposure), on, off; a traced "
            "lens has its own",
            parse_vignetting, [](bool on) { return std::string(on ? "on" : "off"); })),
        number("iso", in::camera(&CameraRequest::iso), {1e-3, 1e9},
               "speed of the film (default 100)"),
        parsed("shutter", in::moment(&MomentRequest::shutter),
               "seconds or degrees: 0.01 or 1/100 (default), 180deg of a frame of ⟨fps⟩; with "
               "⟨at⟩, what moves meanwhile is blurred",
               parse_shutter, [](ShutterTime time) { return text_of(time); }),
        method(text(
            "shutter-curve", in::moment(&MomentRequest::shutter_curve),
            "how it opens and closes: box (default, at once), trapezoid, or a CSV file of time "
            "and openness",
            [](const std::string&) { return std::string(); }))};
}

}  // namespace

std::vector<RequestField> camera_fields() {
    std::vector<RequestField> all = in_group("Camera", kPictures, place_fields());
    for (auto fields : {lens_fields(), exposure_fields()})
        for (RequestField& field : in_group("Lens", kPictures, std::move(fields)))
            all.push_back(std::move(field));
    return all;
}

}  // namespace petzval::apps
