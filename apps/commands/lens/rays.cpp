// SPDX-License-Identifier: Apache-2.0
// petzval lens draw, trace.
#include <fmt/format.h>

#include <algorithm>

#include "apps/cli/readers.h"
#include "apps/commands/lens/field.h"
#include "apps/commands/lens/request.h"
#include "camera/bench/ray_path.h"
#include "camera/lens/traced_ray.h"
#include "io/file/atomic_file.h"
#include "io/lens/lens_drawing.h"
#include "io/lens/ray_table.h"

namespace petzval::apps {
namespace {

struct DrawOptions {
    FieldRequest field;
    std::string out;
    int rays = 5;
};

void draw_command(const DrawOptions& o) {
    refuse_overwriting({{"-o", o.out}}, o.field.request);
    io::check_drawing(o.out);
    const FieldSetup setup = set_up(o.field, {0, 0.7});
    const camera::Lens& lens = *setup.lens;
    io::LensDrawing drawing{
        .section = setup.section, .film_mm = setup.film_mm, .rays = {}, .caption = {}};
    drawing.film_radius_mm = lens.prescription().image_circle_mm / 2;
    const double lead_mm = 0.25 * setup.film_mm;
    std::string fields;
    for (const double deg : setup.fields_deg) {
        fields += fmt::format("{}{:.4g}°", fields.empty() ? "" : ", ", deg);
        for (const camera::SpectralLine& line : camera::kSpectralLines) {
            const camera::AimedBundle bundle = aim(setup, deg, line.nm);
            for (const camera::PupilPoint point : camera::section_points(bundle, o.rays)) {
                drawing.rays.push_back(
                    {camera::ray_path(lens, bundle, point, setup.film_mm, lead_mm), line.colour});
                if (drawing.rays.back().path.size() == size_t(lens.size()) + 2)
                    drawing.film_radius_mm = std::max(drawing.film_radius_mm,
                                                      std::abs(drawing.rays.back().path.back()[1]));
            }
        }
    }
    const camera::Prescription& file = lens.prescription();
    drawing.caption = fmt::format("{}: fields {}; rays of F (blue), d (yellow), C (red)",
                                  file.title.empty() ? file.name : file.title, fields);
    io::write_drawing(o.out, lens, drawing);
}

struct TraceOptions {
    LensRequest request;
    std::string rays, out;
    bool reverse = false, unclipped = false;
};

void trace_command(const TraceOptions& o) {
    refuse_overwriting({{"-o", o.out}}, o.request, {{"the file of --rays", o.rays}});
    io::check_writable(o.out);
    const auto lens = open_lens(o.request);
    const camera::Towards towards = o.reverse ? camera::Towards::Scene : camera::Towards::Film;
    std::vector<camera::TracedRay> traced;
    for (const io::RayToTrace& ray : io::read_rays(o.rays))
        traced.push_back(camera::trace_ray(*lens, ray.origin_mm, ray.direction, ray.nm, towards,
                                           o.unclipped ? camera::Clip::No : camera::Clip::Yes));
    io::write_file_atomically(o.out, io::ray_table(traced, towards, lens->film_mm()));
}

}  // namespace

void add_lens_trace_commands(CLI::App& lens) {
    auto drawn = std::make_shared<DrawOptions>();
    CLI::App* draw = lens.add_subcommand("draw", "draw a cross-section with rays");
    add_field_request(*draw, drawn->field);
    draw->add_option("-o,--output", drawn->out, "drawing to write, .svg")->required();
    draw->add_option("--rays", drawn->rays, "of each field and line, default 5")
        ->transform(whole_number_between(1, 101));
    draw->callback([drawn] { draw_command(*drawn); });

    auto options = std::make_shared<TraceOptions>();
    CLI::App* trace = lens.add_subcommand("trace", "trace the rays of a table");
    add_lens_request(*trace, options->request);
    trace->add_option("--rays", options->rays, "CSV with the columns x,y,z,dx,dy,dz,nm")
        ->required();
    trace->add_option("-o,--output", options->out, "CSV to write")->required();
    trace->add_flag("--reverse", options->reverse, "from the film to the scene");
    trace->add_flag("--unclipped", options->unclipped, "semi-diameters do not stop rays");
    trace->footer(
        "Millimetres; z = 0 at the first vertex, +z towards the film. A ray may begin anywhere on "
        "its line. Rows come in the order of the rays: where and how each leaves the last surface, "
        "where it meets the film, its optical path from the origin, its status (ok, vignetted, "
        "tir, miss) and, if it was blocked, the surface where, counted from 0.");
    trace->callback([options] { trace_command(*options); });
}

}  // namespace petzval::apps
