// SPDX-License-Identifier: Apache-2.0
// Denoised picture of a film, with what is known of its error.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "integrator/denoise/denoise.h"
#include "integrator/render/executor.h"

namespace petzval::apps {

/// Error of a picture or of a part of it: the root of the mean, over its pixels and R, G and B, of
/// squared error / (m^2 + floor^2), m being the mean of what is denoised over 7 x 7 pixels. By the
/// pixel's own brightness an error would look too small: light that is there by chance makes both.
struct DenoisedError {
    double squared = 0;    ///< by the two halves, without bias: it may be negative
    double deviation = 0;  ///< standard error of `squared`, wider where few blocks tell it

    /// Bounds of the root with a chance of 95 %.
    [[nodiscard]] double least() const;
    [[nodiscard]] double most() const;
    /// Whether the halves tell no more than that it is at most most().
    [[nodiscard]] bool is_at_most() const { return squared < 2 * deviation; }
    /// The root; most() where that is all that is known.
    [[nodiscard]] double value() const;
};

/// What a film with halves shows when it is denoised.
struct DenoisedFilm {
    integrator::Denoised picture;
    double floor_nits = 0;  ///< a quarter of its mid-grey
    DenoisedError error;    ///< of the whole
    DenoisedError noisy;    ///< of the picture that is not denoised, by the same measure
    /// Error about each pixel: of the smallest square that tells it to about a third, from 32
    /// pixels on; or the least upper bound of squares about it, where that is less.
    std::vector<float> error_about;
};

/// What is known of the error, in a sentence.
[[nodiscard]] std::string text_of(const DenoisedFilm&);

/// Denoises a film with halves; nothing where `stop` is set meanwhile.
[[nodiscard]] std::shared_ptr<const DenoisedFilm> denoised_film(const Film&,
                                                                integrator::TbbExecutor&,
                                                                const std::atomic<bool>& stop);

}  // namespace petzval::apps
