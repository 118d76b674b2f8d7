// SPDX-License-Identifier: Apache-2.0
// Output pictures of a command: format by file name, display view, never half a file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/base/atomic_file.h"  // check_writable, for what is no picture
#include "io/image/display.h"
#include "io/image/picture.h"

namespace petzval {

/// Display settings of PNG and JPEG; EXR is always scene-linear.
struct DisplayOptions {
    float exposure_ev = 0.f;
    std::string view = {};              ///< empty: the default one of the configuration
    std::filesystem::path config = {};  ///< of OpenColorIO; empty: Petzval's own
};

/// Checks early, before hours of work, that write_output() can do its work. Throws what it would
/// throw for this name, folder and view.
void check_output(const std::filesystem::path&, const DisplayOptions&);

/// Writes a linear picture in the format that the path's ending names. Throws InputError.
void write_output(const std::filesystem::path&, const PictureRows& linear, const DisplayOptions&);

/// Writes an unfinished picture to NAME.partial.exr beside each output NAME.*, once for each name,
/// and returns their names. Throws InputError.
std::vector<std::filesystem::path> write_partial(const std::vector<std::filesystem::path>& outputs,
                                                 const PictureRows& linear);

}  // namespace petzval
