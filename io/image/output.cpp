// SPDX-License-Identifier: Apache-2.0
#include "io/image/output.h"

#include <fmt/format.h>

#include <algorithm>

#include "io/base/error.h"
#include "io/image/picture_files.h"

namespace petzval::io {

void check_output(const std::filesystem::path& path, const DisplayOptions& display, int width,
                  int height) {
    const PictureFormat format = picture_format(path);
    if (format != PictureFormat::Exr) static_cast<void>(find_view(display.view, display.config));
    constexpr int kLargestJpegSide_px = 65500;  // JPEG_MAX_DIMENSION of libjpeg
    if (format == PictureFormat::Jpeg && std::max(width, height) > kLargestJpegSide_px)
        throw OutputError(path.string(), "",
                          "a JPEG has {} pixels on a side at most; write .png or .exr",
                          kLargestJpegSide_px);
    check_writable(path);
}

void write_output(const std::filesystem::path& path, const PictureRows& linear,
                  const DisplayOptions& display) {
    const PictureFormat format = picture_format(path);
    if (format == PictureFormat::Exr) return write_exr(path, linear);
    const AlphaUse use = format == PictureFormat::Png ? AlphaUse::Keep : AlphaUse::OnBlack;
    // What display a view of another configuration is for is not known.
    write_8bit(path, to_display(linear, display.exposure_ev, display.view, use, display.config),
               display.config.empty());
}

std::filesystem::path partial_name(std::filesystem::path output) {
    return output.replace_extension(".partial.exr");
}

std::vector<WriteOutcome> write_partial(const std::vector<std::filesystem::path>& outputs,
                                        const PictureRows& linear) {
    std::vector<WriteOutcome> written;
    for (const std::filesystem::path& output : outputs) {
        const std::filesystem::path path = partial_name(output);
        const auto done = [&](const WriteOutcome& one) { return one.wanted == path; };
        if (std::none_of(written.begin(), written.end(), done))
            written.push_back(write_or_rescue(
                path, [&](const std::filesystem::path& to) { write_exr(to, linear); }));
    }
    return written;
}

}  // namespace petzval::io
