// SPDX-License-Identifier: Apache-2.0
// Sequences of renders: frames of an animation, views around a scene, values of an option.
#pragma once

#include "apps/cli/render_options.h"
#include "apps/commands/session.h"
#include "io/base/notice.h"

namespace petzval {

/// Whether the options ask for several pictures.
[[nodiscard]] bool is_sequence(const RenderOptions&);

/// Renders the pictures of a sequence, each as a command of its own would: session.words with those
/// of the picture. What the first one finds by itself (view, focus, exposure) holds for all. One
/// that fails does not end the others; a signal does. The exit code: that of the first that failed.
[[nodiscard]] int render_sequence(const RenderOptions&, const Notice&, Session&);

}  // namespace petzval
