// SPDX-License-Identifier: Apache-2.0
// petzval lens list, show, check.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>

#include "apps/cli/console.h"
#include "apps/cli/or_null.h"
#include "apps/cli/readers.h"
#include "apps/commands/lens/request.h"
#include "apps/request/parse.h"
#include "camera/bench/analysis.h"
#include "camera/lens/blockage.h"
#include "camera/lens/focus.h"
#include "io/base/error.h"
#include "io/base/printable.h"
#include "io/lens/lens_file.h"

namespace petzval::apps {
namespace {

using Json = nlohmann::ordered_json;

void list_command() {
    fmt::print("{:<33} {:>6} {:>9} {:>8}  {}\n{:<33} {:>6} {:>9} {:>8}\n", "lens", "focal",
               "f-number", "angle", "design (patent)", "", "mm", "stated", "degrees");
    for (const io::LensSummary& lens : io::list_lenses())
        print_line(fmt::format("{:<33} {:>6g} {:>9} {:>8.4g}  {}{}", lens.name,
                               lens.focal_length_mm, fmt::format("f/{:g}", lens.fnumber),
                               2 * lens.field_half_deg, lens.title,
                               lens.patent.empty() ? "" : " (" + lens.patent + ")"));
}

std::string shape_of(const camera::LensSurface& s) {
    std::string out;
    if (s.stop) out += " stop";
    if (s.profile == camera::Profile::CylinderX) out += " cylinder along x";
    if (s.profile == camera::Profile::CylinderY) out += " cylinder along y";
    if (s.conic != 0) out += fmt::format(" k = {:g}", s.conic);
    for (const auto& [power, coefficient] : s.asphere)
        out += fmt::format(" A{} = {:g}", power, coefficient);
    if (const auto* layers = std::get_if<camera::LayerStack>(&s.coat))
        out += fmt::format(" coating of {} layers", layers->size());
    for (const auto& [name, coating] : camera::kCoatingNames)
        if (coating != camera::Coating::Uncoated && s.coat == camera::SurfaceCoat(coating))
            out += fmt::format(" coating {}", name);
    return out;
}

void show_command(const LensRequest& request) {
    const auto lens = open_lens(request);
    const camera::Prescription& file = lens->prescription();
    print_line(file.name + (file.title.empty() ? "" : ": ") + file.title);
    if (!file.source.empty()) print_line("source: " + file.source);
    const auto print_if = [](const char* format, std::optional<double> value) {
        if (value) fmt::print(fmt::runtime(format), *value);
    };
    print_if("focal length {:g} mm\n", file.stated_focal_length_mm);
    print_if("f/{:g}, as the file states\n", file.stated_fnumber);
    print_if("half field {:g}°\n", file.stated_field_half_deg);
    if (file.image_circle_mm > 0) fmt::print("image circle {:g} mm\n", file.image_circle_mm);
    if (file.focus_group)
        fmt::print("focuses by surfaces {} to {}\n", (*file.focus_group)[0],
                   (*file.focus_group)[1]);
    fmt::print("\n{:>2} {:>12} {:>12} {:>10}  {:<20} {:>8} {:>6}\n", "", "radius mm",
               "thickness mm", "semi-diam.", "glass", "nd", "vd");
    for (size_t i = 0; i < file.surfaces.size(); ++i) {
        const camera::LensSurface& s = file.surfaces[i];
        const std::string radius =
            s.curvature_1_mm == 0 ? "plane" : fmt::format("{:.8g}", 1 / s.curvature_1_mm);
        const std::string glass =
            s.glass ? fmt::format("{:<20} {:>8.6f} {:>6.2f}", io::visible(s.glass->name),
                                  s.glass->index(kLineD_nm), s.glass->abbe())
                    : fmt::format("{:<36}", "");
        fmt::print("{:>2} {:>12} {:>12.8g} {:>10.6g}  {}{}\n", i, radius, s.thickness_mm,
                   s.semi_diameter_mm, glass, shape_of(s));
    }
}

constexpr std::array<std::pair<const char*, double>, 3> kLines{
    {{"F", kLineF_nm}, {"d", kLineD_nm}, {"C", kLineC_nm}}};

struct Check {
    std::vector<std::pair<std::string, camera::FirstOrder>>
        first_order;                  ///< by line, and by section
    double traced_fnumber;            ///< the smallest, by real rays
    std::optional<double> field_deg;  ///< of the Seidel sums
    std::optional<camera::Seidel> seidel;
    std::vector<camera::StatedFigure> stated;
    camera::FieldAndCircle field;
};

Check check(const camera::Lens& lens) {
    Check out;
    const auto stop = static_cast<size_t>(lens.stop());
    out.traced_fnumber =
        camera::fnumber_of(lens, lens.prescription().surfaces[stop].semi_diameter_mm);
    for (const auto& [name, nm] : kLines) {
        const std::string line = fmt::format("{} {:.4f} nm", name, nm);
        if (lens.of_revolution()) {
            out.first_order.push_back({line, camera::first_order(lens, nm)});
            continue;
        }
        out.first_order.push_back(
            {line + ", y", camera::first_order(lens, nm, camera::Section::Y)});
        out.first_order.push_back(
            {line + ", x", camera::first_order(lens, nm, camera::Section::X)});
    }
    out.stated = camera::stated_figures(lens);
    out.field = camera::field_and_circle(lens);
    if (!lens.of_revolution()) return out;
    // The sums are for the tangent of the field, which grows without bounds.
    constexpr double widest_deg = 60;
    out.field_deg = camera::field_half_deg(lens.prescription());
    if (out.field_deg) out.field_deg = std::min(*out.field_deg, widest_deg);
    out.seidel = camera::seidel(lens, std::tan(out.field_deg.value_or(0) * std::numbers::pi / 180));
    return out;
}

using Figure = std::pair<const char*, double camera::FirstOrder::*>;
constexpr std::array<Figure, 10> kFigures{
    {{"focal_length_mm", &camera::FirstOrder::focal_length_mm},
     {"back_focus_mm", &camera::FirstOrder::back_focus_mm},
     {"front_focus_mm", &camera::FirstOrder::front_focus_mm},
     {"front_principal_mm", &camera::FirstOrder::front_principal_mm},
     {"rear_principal_mm", &camera::FirstOrder::rear_principal_mm},
     {"entrance_pupil_mm", &camera::FirstOrder::entrance_pupil_mm},
     {"exit_pupil_mm", &camera::FirstOrder::exit_pupil_mm},
     {"entrance_pupil_diameter_mm", &camera::FirstOrder::entrance_pupil_diameter_mm},
     {"exit_pupil_diameter_mm", &camera::FirstOrder::exit_pupil_diameter_mm},
     {"fnumber", &camera::FirstOrder::fnumber}}};
constexpr std::array<const char*, 7> kSums{"S1", "S2", "S3", "S4", "S5", "C1", "C2"};

void print_check(const camera::Lens& lens, const Check& c) {
    print_line(lens.prescription().name);
    fmt::print("\n{:<28}", "");
    for (const auto& [line, data] : c.first_order) fmt::print(" {:>16}", line);
    fmt::print("\n");
    for (const auto& [name, member] : kFigures) {
        fmt::print("{:<28}", name);
        for (const auto& [line, data] : c.first_order) fmt::print(" {:>16.6f}", data.*member);
        fmt::print("\n");
    }
    fmt::print(
        "\nfnumber above is paraxial: focal length / diameter of the entrance pupil\n"
        "smallest f-number by real rays, that of --fstop: {:.4f}\n  {}\n",
        c.traced_fnumber, camera::kTracedFnumber);
    if (c.seidel) {
        fmt::print("\nSeidel sums (mm), wide open, {}\n{:>7}",
                   c.field_deg ? fmt::format("half field {:g}°", *c.field_deg)
                               : "on the axis, as the file states no field",
                   "");
        for (const char* name : kSums) fmt::print(" {:>11}", name);
        const auto row = [](const camera::SeidelSums& sums) {
            for (const double sum : sums) fmt::print(" {:>11.6f}", sum);
        };
        for (size_t i = 0; i < c.seidel->of_surface.size(); ++i) {
            fmt::print("\n{:>7}", i);
            row(c.seidel->of_surface[i]);
        }
        fmt::print("\n{:>7}", "sum");
        row(c.seidel->total);
        fmt::print("\n");
    }
    fmt::print("\n{:<33} {:>12} {:>12} {:>10}\n", "", "file states", "comes out", "differs");
    for (const camera::StatedFigure& figure : c.stated)
        fmt::print("{:<33} {:>12.6g} {:>12.6g} {:>8.3f} %\n", figure.name, figure.stated,
                   figure.computed, 100 * figure.relative());
    const auto reached = [](const char* before, std::optional<double> value, const char* unit) {
        return value ? fmt::format("{}{:.4g}{}", before, *value, unit)
                     : std::string("no chief ray of it");
    };
    if (const auto& f = c.field; f.half_field_deg)
        fmt::print("\nhalf field {:g}°, as the file states: {} on the film\n", *f.half_field_deg,
                   reached("a circle of ", f.circle_of_half_field_mm, " mm"));
    if (const auto& f = c.field; f.image_circle_mm)
        fmt::print("image circle {:g} mm, as the file states: {} before the lens\n",
                   *f.image_circle_mm,
                   reached("a half field of ", f.half_field_of_image_circle_deg, "°"));
}

Json json_of(const camera::Lens& lens, const Check& c) {
    Json out;
    out["name"] = lens.prescription().name;
    for (const auto& [line, data] : c.first_order)
        for (const auto& [name, member] : kFigures) out["first_order"][line][name] = data.*member;
    out["fnumber_by_real_rays"] = c.traced_fnumber;
    out["seidel"] = nullptr;
    if (c.seidel) {
        Json& sums = out["seidel"] = Json::object();
        sums["half_field_deg"] = c.field_deg.value_or(0);
        sums["columns"] = kSums;
        sums["of_surface"] = c.seidel->of_surface;
        sums["total"] = c.seidel->total;
    }
    for (const camera::StatedFigure& figure : c.stated)
        out["stated"].push_back({{"figure", figure.name},
                                 {"stated", figure.stated},
                                 {"computed", figure.computed},
                                 {"relative_difference", figure.relative()}});
    out["field"] = {
        {"half_field_deg", or_null(c.field.half_field_deg)},
        {"circle_of_half_field_mm", or_null(c.field.circle_of_half_field_mm)},
        {"image_circle_mm", or_null(c.field.image_circle_mm)},
        {"half_field_of_image_circle_deg", or_null(c.field.half_field_of_image_circle_deg)}};
    return out;
}

struct CheckOptions {
    LensRequest request;
    bool json = false;
    std::optional<double> fail_above_percent;
};

void check_command(const CheckOptions& o) {
    const auto lens = open_lens(o.request);
    const Check result = check(*lens);
    if (const auto blockage = camera::find_blockage(*lens))
        print_notice("warning: it lets no light through to the middle of the film: " +
                     blockage->text());
    if (o.json)
        fmt::print("{}\n",
                   json_of(*lens, result).dump(2, ' ', true, Json::error_handler_t::replace));
    else
        print_check(*lens, result);
    std::fflush(stdout);  // the result comes before a complaint
    if (!o.fail_above_percent) return;
    for (const camera::StatedFigure& figure : result.stated)
        if (!(std::fabs(100 * figure.relative()) <= *o.fail_above_percent))
            throw io::InputError(o.request.lens, "",
                                 "{}: {:.6g} is stated and {:.6g} comes out, which differs "
                                 "by more than {:g} %",
                                 figure.name, figure.stated, figure.computed,
                                 *o.fail_above_percent);
}

}  // namespace

void add_lens_table_commands(CLI::App& lens) {
    lens.add_subcommand("list", "print the lenses that ship")->callback(list_command);

    auto shown = std::make_shared<LensRequest>();
    CLI::App* show = lens.add_subcommand("show", "print a lens's surfaces and glasses");
    add_lens_request(*show, *shown);
    show->callback([shown] { show_command(*shown); });

    auto options = std::make_shared<CheckOptions>();
    CLI::App* check =
        lens.add_subcommand("check",
                            "print first-order data and Seidel sums, and compare what "
                            "the file states with what comes out");
    add_lens_request(*check, options->request);
    check->add_flag("--json", options->json, "print JSON");
    check
        ->add_option("--fail-above", options->fail_above_percent,
                     "exit with 1 if a stated figure is further off than this, in per cent")
        ->transform(number_between(0, 1e6));
    check->footer(
        "Pupils and foci count from the vertex on their side of the lens. Seidel sums "
        "are Welford's, for a distant object and half fields of 60° at most.");
    check->callback([options] { check_command(*options); });
}

}  // namespace petzval::apps
