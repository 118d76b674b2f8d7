// SPDX-License-Identifier: Apache-2.0
// What the module offers to whoever loads it.
#include <OpenImageIO/imageio.h>

#include <string>

#include "io/base/machine.h"
#include "io/build/build.h"
#include "io/codec/codec.h"
#include "io/picture/image_codec.h"

namespace petzval::io::codec {
namespace {

void limit_threads(int threads) {
    // Not "threads": OpenImageIO starts its own pool, which nothing here uses, to set its size.
    OIIO::attribute("exr_threads", threads);
}

const std::string kVersion = program_version();

/// The table is made when the module is loaded, which also sets the usual limit.
ImageCodec made_at_load() {
    limit_threads(usable_threads());
    return {kVersion.c_str(), read_picture, read_metadata, decode_image,
            write_exr,        write_8bit,   draw_text,     limit_threads};
}

const ImageCodec kCodec = made_at_load();

}  // namespace
}  // namespace petzval::io::codec

extern "C" [[gnu::visibility("default")]] const petzval::io::ImageCodec* petzval_image_codec() {
    return &petzval::io::codec::kCodec;
}
