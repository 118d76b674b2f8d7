// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/image/shown.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>

#include "apps/cli/console.h"
#include "apps/cli/display_options.h"
#include "apps/cli/field_options.h"
#include "apps/setup/exposure.h"
#include "apps/setup/input_files.h"
#include "io/base/error.h"

namespace petzval {
namespace {

/// Indices of R, G and B, or of Y as each of them: below 0 where there is none.
std::array<int, 3> colours_of(const Picture& p) {
    const int grey = channel_index(p, "Y");
    const auto from = [&](const char* name) { return grey < 0 ? channel_index(p, name) : grey; };
    return {from("R"), from("G"), from("B")};
}

bool has_colours(const Picture& p) {
    const std::array<int, 3> at = colours_of(p);
    return *std::min_element(at.begin(), at.end()) >= 0;
}

/// Luminances of the pixels that show something, for exposure_for().
std::vector<double> luminances_of(const Picture& p) {
    std::vector<double> out;
    if (!has_colours(p)) return out;
    const std::array<int, 3> at = colours_of(p);
    const int alpha = channel_index(p, "A");
    for (auto pixel = p.pixels.begin(); pixel != p.pixels.end(); pixel += p.channels.size()) {
        const double light = double(luminance(Rgb(pixel[at[0]], pixel[at[1]], pixel[at[2]])));
        const double opaque = alpha < 0 ? 1 : double(pixel[alpha]);
        if (const double seen = light / opaque; opaque > 0 && seen > 0 && std::isfinite(seen))
            out.push_back(seen);
    }
    return out;
}

}  // namespace

void add_shown_options(CLI::App& app, ShownOptions& o) {
    for (const char* field : {"exposure", "view", "ocio", "max-memory"})
        add_field_option(app, o.order, field);
}

void begin_showing(ShownOptions& o, const std::string& output,
                   const std::vector<NamedFile>& inputs) {
    DisplayRequest& asked = o.order.render.display;
    const auto exposure = asked.exposure.value_or(ExposureRequest());
    o.exposure_known = !exposure.is_auto;
    if (const std::string told = resolve_display(asked); !told.empty()) print_notice(told);
    o.display = {exposure.ev, find_view(asked.view, asked.config), asked.config};
    const std::vector<NamedFile> outputs{{"-o", output}};
    refuse_overwriting(outputs, inputs);
    refuse_overwriting(outputs, input_files(asked));
    refuse_overwriting(outputs, own_files());
}

void settle_exposure(ShownOptions& o, const Picture& picture) {
    if (o.exposure_known) return;
    o.display.exposure_ev = exposure_for(luminances_of(picture)).ev;
    o.exposure_known = true;
    print_notice(fmt::format("exposure: {0} EV (--exposure {0})", o.display.exposure_ev));
}

PictureRows shown(const Picture& picture, const std::string& file, ShownOptions& o, AlphaUse use) {
    if (!has_colours(picture))
        throw InputError(file, "", "has no channels R, G and B (nor Y) to show");
    if (picture.for_display) return as_display(picture);
    settle_exposure(o, picture);
    return to_display(picture, o.display.exposure_ev, o.display.view, use, o.display.config);
}

}  // namespace petzval
