// SPDX-License-Identifier: Apache-2.0
// How the commands of petzval image show a picture on a display.
#pragma once

#include <string>
#include <vector>

#include "apps/request/render_order.h"
#include "io/base/overwrite.h"
#include "io/image/display.h"
#include "io/image/output.h"
#include "io/picture/picture.h"

namespace CLI {
class App;
}

namespace petzval {

/// Exposure, view, configuration and memory as asked for, and what was settled of them.
struct ShownOptions {
    RenderOrder order;
    DisplayOptions display;
    bool exposure_known = false;  ///< else it is found from a picture
};

/// Declares the options; they write to the struct, which must outlive the parsing.
void add_shown_options(CLI::App&, ShownOptions&);

/// Settles what can be without a picture, and tells it; refuses an output that is one of these
/// inputs, or any other file that the command reads. Throws what is wrong.
void begin_showing(ShownOptions&, const std::string& output, const std::vector<NamedFile>& inputs);

/// Settles the exposure by a picture of light, where it is to be found, and tells it.
void settle_exposure(ShownOptions&, const Picture&);

/// Display picture of a picture from a file: values for a display as they are, light through the
/// view. Throws InputError where it has no colours.
[[nodiscard]] PictureRows shown(const Picture&, const std::string& file, ShownOptions&, AlphaUse);

}  // namespace petzval
