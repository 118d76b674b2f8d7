// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace petzval::apps {

/// Exit codes of the program; docs/guide/render.md lists them.
inline constexpr int kSuccess = 0;
inline constexpr int kFailure = 1;  ///< an input cannot be used, or a limit is exceeded
inline constexpr int kUsage = 2;    ///< arguments that are wrong
inline constexpr int kOutputFailed = 3;
inline constexpr int kOutOfMemory = 4;
inline constexpr int kNoiseLeft = 5;  ///< pictures are written, with more noise than was asked for
inline constexpr int kStopped = 130;  ///< by any of the signals that Interrupt waits for

}  // namespace petzval::apps
