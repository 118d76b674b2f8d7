// SPDX-License-Identifier: Apache-2.0
// Sequences of renders: frames of an animation, views around a scene, values of a field.
#pragma once

#include "apps/commands/session.h"
#include "apps/request/render_order.h"
#include "io/base/notice.h"

namespace petzval::apps {

/// Renders the pictures of a sequence, each as an order of its own would. What the first one finds
/// by itself (view, focus, exposure) holds for all. One that fails does not end the others; a
/// signal does. The exit code: that of the first that failed.
[[nodiscard]] int render_sequence(const RenderOrder&, const io::Notice&, Session&);

}  // namespace petzval::apps
