// SPDX-License-Identifier: Apache-2.0
#include "apps/lens_field.h"

#include <fmt/format.h>

#include <limits>
#include <stdexcept>

#include "apps/choice.h"
#include "camera/analysis.h"
#include "io/error.h"

namespace petzval {
namespace {

constexpr double kWidest_deg = 120, kWidestNear_deg = 85, kFarthest_m = 1e9, kNearest_m = 1e-3;

double number_of(const std::string& option, const std::string& text, double least, double most) {
    if (const std::string wrong = number_between(least, most)(text); !wrong.empty())
        throw CLI::ValidationError(option, wrong);
    return std::stod(text);
}

std::vector<double> parse_fields(const std::string& text, double widest_deg) {
    std::vector<double> out;
    for (const std::string& part : CLI::detail::split(text, ','))
        out.push_back(number_of("--field", part, 0, widest_deg));
    return out;
}

}  // namespace

void add_field_request(CLI::App& app, FieldRequest& request, bool with_fields) {
    add_lens_request(app, request.request);
    if (with_fields)
        app.add_option("--field", request.fields,
                       "angles from the axis in degrees, as 0,10,14 (default: parts of the lens's "
                       "half field)");
    app.add_option("--focus", request.focus,
                   "metres from the entrance pupil to the plane of focus, where the object lies "
                   "(default: infinity); the whole lens is moved to focus");
    app.add_option("--film-shift", request.film_shift,
                   "mm that the film lies behind the paraxial image of line d, or best: where the "
                   "spot on the axis has the least RMS radius for F, d and C together (default 0)");
    add_choice<std::string>(app, "--section", request.section, {{"y", "y"}, {"x", "x"}},
                            "the side to which the field is: y (default), x");
}

FieldSetup set_up(const Lens& lens, const FieldRequest& request,
                  const std::vector<double>& shares) try {
    FieldSetup out;
    out.section = request.section == "x" ? Section::X : Section::Y;
    out.distance_mm = std::numeric_limits<double>::infinity();
    if (!request.focus.empty() && request.focus != "infinity")
        out.distance_mm = 1000 * number_of("--focus", request.focus, kNearest_m, kFarthest_m);
    const double widest_deg = std::isfinite(out.distance_mm) ? kWidestNear_deg : kWidest_deg;
    if (!request.fields.empty()) {
        out.fields_deg = parse_fields(request.fields, widest_deg);
    } else if (!shares.empty()) {
        const auto half = field_half_deg(lens.prescription());
        if (!half)
            throw ArgumentError(request.request.lens, "",
                                "does not state its field or image circle; give --field");
        for (const double share : shares)
            out.fields_deg.push_back(std::min(share * *half, widest_deg));
    }
    out.film_mm = film_focused_mm(lens, out.distance_mm);
    if (request.film_shift == "best")
        out.film_mm += best_film_shift_mm(lens, out.film_mm, out.distance_mm);
    else if (!request.film_shift.empty())
        out.film_mm += number_of("--film-shift", request.film_shift, -1e4, 1e4);
    return out;
} catch (const std::invalid_argument& error) {
    throw ArgumentError(request.request.lens, "", error.what());
}

Beam aim(const Lens& lens, const FieldSetup& setup, double field_deg, double nm) {
    auto beam = Beam::aim(lens, {field_deg, setup.distance_mm, setup.section}, nm);
    if (!beam)
        throw ArgumentError(
            lens.prescription().name, "",
            fmt::format("no ray at {:g}° and {:g} nm reaches the middle of the stop; give a "
                        "smaller --field",
                        field_deg, nm));
    return *std::move(beam);
}

}  // namespace petzval
