// SPDX-License-Identifier: Apache-2.0
#include "apps/commands/image/view.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include "apps/cli/console.h"
#include "apps/cli/field_options.h"
#include "apps/request/file_names.h"
#include "apps/setup/display_setup.h"
#include "apps/setup/exposure.h"
#include "apps/setup/input_files.h"
#include "apps/state/render_facts.h"
#include "io/image/output.h"
#include "io/image/picture_files.h"

namespace petzval::apps {
namespace {

struct ViewRequest {
    std::string in, out;
    RenderOrder order;
};

/// Indices of R, G and B, or of Y as each of them: below 0 where there is none.
std::array<int, 3> colours_of(const io::Picture& p) {
    const int grey = io::channel_index(p, "Y");
    const auto from = [&](const char* name) {
        return grey < 0 ? io::channel_index(p, name) : grey;
    };
    return {from("R"), from("G"), from("B")};
}

/// Puts the denoised colours of a picture in the place of R, G and B; false where it has none.
bool take_denoised(io::Picture& p) {
    if (io::channel_index(p, "Y") >= 0) return false;  // that is what is shown
    const std::array<int, 3> to = colours_of(p);
    const std::array<int, 3> from{io::channel_index(p, "denoised.R"),
                                  io::channel_index(p, "denoised.G"),
                                  io::channel_index(p, "denoised.B")};
    if (std::min(std::ranges::min(to), std::ranges::min(from)) < 0) return false;
    for (auto pixel = p.pixels.begin(); pixel != p.pixels.end(); pixel += p.channels.size())
        for (size_t c = 0; c < 3; ++c) pixel[to[c]] = pixel[from[c]];
    return true;
}

/// Luminances of the pixels that show something, for exposure_for().
std::vector<double> luminances_of(const io::Picture& p) {
    std::vector<double> out;
    const std::array<int, 3> at = colours_of(p);
    if (*std::min_element(at.begin(), at.end()) < 0) return out;
    const int alpha = io::channel_index(p, "A");
    for (auto pixel = p.pixels.begin(); pixel != p.pixels.end(); pixel += p.channels.size()) {
        const double light = double(luminance(Rgb(pixel[at[0]], pixel[at[1]], pixel[at[2]])));
        const double opaque = alpha < 0 ? 1 : double(pixel[alpha]);
        if (const double seen = light / opaque; opaque > 0 && seen > 0 && std::isfinite(seen))
            out.push_back(seen);
    }
    return out;
}

void view_command(ViewRequest& o) {
    DisplayRequest& asked = o.order.render.display;
    const auto exposure = asked.exposure.value_or(ExposureRequest());
    if (const std::string told = resolve_display(asked); !told.empty()) print_notice(told);
    io::DisplayOptions display{exposure.ev, io::find_view(asked.view, asked.config), asked.config};
    const std::vector<io::NamedFile> outputs{{"-o", o.out}};
    io::refuse_overwriting(outputs, {{"the picture to show", o.in}});
    io::refuse_overwriting(outputs, input_files(asked));
    io::refuse_overwriting(outputs, own_files());
    io::PictureBudget pictures = o.order.render.scene.pictures();
    io::Picture picture = io::read_picture(o.in, pictures);
    if (picture.for_display)
        print_notice(
            fmt::format("warning: {} holds values for a display already, and goes through the view "
                        "as if they were light",
                        o.in));
    if (take_denoised(picture)) print_notice(fmt::format("shows the denoised picture of {}", o.in));
    if (exposure.is_auto) {
        display.exposure_ev = exposure_for(luminances_of(picture)).ev;
        print_notice(fmt::format("exposure: {0} EV (--exposure {0})", display.exposure_ev));
    }
    picture.metadata.emplace_back(kDisplayHash, display_hash(display_facts(display)));
    io::write_output(o.out, picture, display);
}

}  // namespace

void add_view(CLI::App& image) {
    auto options = std::make_shared<ViewRequest>();
    CLI::App* view = image.add_subcommand("view", "write a linear picture as PNG or JPEG");
    view->add_option("picture", options->in, "linear picture, as .exr")->required();
    view->add_option("-o,--output", options->out, "picture to write, .png or .jpg")
        ->required()
        ->check(complaint_about_display_name);
    for (const char* field : {"exposure", "view", "ocio", "max-memory"})
        add_field_option(*view, options->order, field);
    view->callback([options] { view_command(*options); });
}

}  // namespace petzval::apps
