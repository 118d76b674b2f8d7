// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/lens/field.h"

#include <fmt/format.h>

#include <cmath>

#include "apps/cli/choice.h"
#include "apps/cli/console.h"
#include "camera/bench/analysis.h"
#include "camera/lens/blockage.h"
#include "io/base/error.h"

namespace petzval::apps {
namespace {

constexpr double kWidest_deg = 120, kWidestNear_deg = 85;

std::vector<double> parse_fields(const std::string& text, double widest_deg) {
    std::vector<double> out;
    for (const std::string_view part : io::split(text, ','))
        out.push_back(parse_number("--field", std::string(part), {0, widest_deg, kDegrees}));
    return out;
}

camera::LensBench in_focus(const camera::Lens& lens, const FieldRequest& request,
                           double distance_mm) {
    if (auto sharp = camera::LensBench::focused(
            lens, distance_mm, request.focus_by.value_or(camera::FocusBy::Paraxial)))
        return *std::move(sharp);
    if (!std::isfinite(distance_mm))
        throw io::ArgumentError(request.request.lens, "",
                                "forms no image of a distant object; give --focus a distance");
    throw io::ArgumentError(
        request.request.lens, "", "--focus {} is too near for {}; give a greater distance",
        request.focus, lens.prescription().focus_group ? "the group that focuses" : "the lens");
}

std::shared_ptr<const camera::Lens> at_fstop(const std::shared_ptr<const camera::Lens>& lens,
                                             const std::string& text) {
    const double fnumber = parse_fnumber("--fstop", text, {1e-2, 1e6});
    if (auto stopped = camera::stopped_down(*lens, fnumber))
        return std::make_shared<const camera::Lens>(*std::move(stopped));
    const auto stop = static_cast<size_t>(lens->stop());
    print_notice(
        fmt::format("warning: {} opens to f/{:.3g} at most, not to f/{:g}: an f-number is {}",
                    lens->prescription().name,
                    camera::fnumber_of(*lens, lens->prescription().surfaces[stop].semi_diameter_mm),
                    fnumber, camera::kTracedFnumber));
    return lens;
}

}  // namespace

void add_field_request(CLI::App& app, FieldRequest& request, bool with_fields) {
    add_lens_request(app, request.request);
    if (with_fields)
        app.add_option("--field", request.fields,
                       "angles from the axis in degrees, as 0,10,14 (default: parts of the lens's "
                       "half field)");
    app.add_option("--focus", request.focus,
                   "distance (1.5m, 30cm, 5ft; 1.5 is metres) from the entrance pupil of the lens "
                   "in focus to the plane of focus, where the object lies, or infinity; the whole "
                   "lens moves, or the "
                   "group that its file names (default: a distant object, and the lens as filed)");
    add_choice<std::optional<camera::FocusBy>>(
        app, "--focus-by", request.focus_by,
        Choices<std::optional<camera::FocusBy>>{{"paraxial", camera::FocusBy::Paraxial},
                                                {"traced", camera::FocusBy::Traced}},
        "paraxial (default): line d near the axis; traced: the spot on the axis with the least "
        "RMS radius for F, d and C together");
    app.add_option("--film-shift", request.film_shift,
                   "mm that the film lies behind that place, or best: where the spot on the axis "
                   "has the least RMS radius (default 0)");
    app.add_option("--fstop", request.fstop,
                   "f-number, as 8 or f/8: the iris closes (default: as wide as the lens's file "
                   "says)");
    add_choice<std::string>(app, "--section", request.section, {{"y", "y"}, {"x", "x"}},
                            "the side to which the field is: y (default), x");
}

FieldSetup set_up(const FieldRequest& request, const std::vector<double>& shares) {
    std::shared_ptr<const camera::Lens> lens = open_lens(request.request);
    if (!request.fstop.empty()) lens = at_fstop(lens, request.fstop);
    FieldSetup out{camera::LensBench(std::move(lens)),
                   {},
                   request.section == "x" ? camera::Section::X : camera::Section::Y};
    if (!request.focus.empty())
        out.distance_mm = 1e3 * double(parse_focus_distance_m("--focus", request.focus));
    const double widest_deg = std::isfinite(out.distance_mm) ? kWidestNear_deg : kWidest_deg;
    if (!request.fields.empty()) {
        out.fields_deg = parse_fields(request.fields, widest_deg);
    } else if (!shares.empty()) {
        const auto half = camera::field_half_deg(out.lens->prescription());
        if (!half)
            throw io::ArgumentError(request.request.lens, "",
                                    "does not state its field or image circle; give --field");
        for (const double share : shares)
            out.fields_deg.push_back(std::min(share * *half, widest_deg));
    }
    if (!request.focus.empty() || request.focus_by)
        static_cast<camera::LensBench&>(out) = in_focus(*out.lens, request, out.distance_mm);
    if (request.film_shift == "best") {
        const auto shift = out.best_film_shift_mm();
        if (!shift)
            throw io::ArgumentError(
                request.request.lens, "",
                "no ray along the axis reaches the film; give --film-shift in mm");
        out.film_mm += *shift;
    } else if (!request.film_shift.empty())
        out.film_mm += parse_number("--film-shift", request.film_shift, {-1e4, 1e4, kMillimetres});
    return out;
}

void require_light(const camera::Lens& lens) {
    if (const auto blockage = camera::find_blockage(lens))
        throw io::ArgumentError(
            lens.prescription().name, "",
            "lets no light through to the middle of the film: " + blockage->text());
}

camera::AimedBundle aim(const FieldSetup& setup, double field_deg, double nm) {
    auto bundle = setup.aim(field_deg, nm, setup.section);
    if (!bundle)
        throw io::ArgumentError(
            setup.lens->prescription().name, "",
            "no ray at {:g}° and {:g} nm reaches the middle of the stop; give a "
            "smaller --field",
            field_deg, nm);
    return *std::move(bundle);
}

}  // namespace petzval::apps
