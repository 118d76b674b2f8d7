// SPDX-License-Identifier: Apache-2.0
// The pictures that a command writes: which format, which view, and never half of one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "io/base/atomic_file.h"  // check_writable, for what is no picture
#include "io/image/display.h"
#include "io/image/picture.h"

namespace petzval {

/// How PNG and JPEG show a linear picture; EXR is always scene-linear.
struct DisplayOptions {
    float exposure_ev = 0.f;
    std::string view = kDefaultView;
};

/// Throws what write_output would throw for this name, folder and view: to be asked before hours of
/// work.
void check_output(const std::filesystem::path&, const DisplayOptions&);

/// Writes a linear picture in the format that the path's ending names. Throws InputError.
void write_output(const std::filesystem::path&, const PictureRows& linear, const DisplayOptions&);

/// Writes an unfinished picture to NAME.partial.exr beside each output NAME.*, once for each name,
/// and says where. Throws InputError.
std::vector<std::filesystem::path> write_partial(const std::vector<std::filesystem::path>& outputs,
                                                 const PictureRows& linear);

}  // namespace petzval
