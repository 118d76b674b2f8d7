// SPDX-License-Identifier: Apache-2.0
#include "io/image/threads.h"

#include <OpenImageIO/imageio.h>

namespace petzval {

void limit_picture_threads(int threads) {
    // Not "threads": OpenImageIO starts its own pool, which nothing here uses, to set its size.
    OIIO::attribute("exr_threads", threads);
}

}  // namespace petzval
