// SPDX-License-Identifier: Apache-2.0
// Plans of small frames, for tests of what they find and say.
#pragma once

#include "apps/plan/plan.h"
#include "apps/plan/plan_comparison.h"
#include "io/image/symmetric_mse.h"
#include "tests/support/cli_spectral.h"

namespace petzval::apps {

inline const auto kSilent = [](const std::string&) {};

inline const std::string kFirstLight = PETZVAL_ASSETS "/scenes/first_light.glb",
                         kOrnaments = PETZVAL_ASSETS "/scenes/ornaments.glb";

class Plans : public CliSpectral {
  protected:
    integrator::TbbExecutor executor_{2};

    [[nodiscard]] SceneRequest request(const std::string& scene, V2i size) const {
        SceneRequest r;
        r.scene = scene;
        r.size = size;
        return r;
    }
    /// The built-in scene through a lens.
    [[nodiscard]] SceneRequest tabletop(V2i size, const char* lens = "takumar-50mm-f1.2") const {
        SceneRequest r = request(kFirstLight, size);
        r.camera.lens = lens;
        r.camera.focus = FocusDistance{2};
        return r;
    }
    [[nodiscard]] std::unique_ptr<PilotModel> model(const Pilot& pilot,
                                                    const SceneRequest& r) const {
        return pilot.model(set_up_render(r, kSilent), integrator::RenderJob(),
                           integrator::PathOptions());
    }
    /// Symmetric MSE of a against b without noise, and of the noise of a.
    [[nodiscard]] static Estimate bias(const Pilot& pilot, const PilotModel& a,
                                       const PilotModel& b) {
        return square_error(pilot, {{&a, 1}, {&b, -1}}, {&a, &b, pilot_floor(pilot, b)});
    }
    [[nodiscard]] static Estimate noise(const Pilot& pilot, const PilotModel& a,
                                        const PilotModel& b) {
        return noise_of(pilot, a, {&a, &b, pilot_floor(pilot, b)}).variances.back();
    }
    [[nodiscard]] static SceneRequest with(SceneRequest r, camera::DispersionMode dispersion) {
        r.spectral.mode = SpectralMode::Wavelengths;
        r.camera.dispersion = dispersion;
        return r;
    }
    /// petzval plan with small settings where the words have none of their own; must succeed.
    [[nodiscard]] json planned(Words words) {
        words.insert(words.begin(), {"plan", scene_, "--json", "--quiet", "--threads", "2"});
        if (std::find(words.begin(), words.end(), "--size") == words.end())
            words.insert(words.end(), {"--size", "32x18"});
        const Finished run = run_petzval(words);
        EXPECT_EQ(run.exit_code, 0) << run.err;
        EXPECT_EQ(run.err, "");
        return json::parse(run.out, nullptr, false);
    }
};

}  // namespace petzval::apps
