// SPDX-License-Identifier: Apache-2.0
// What the textures of a material's layers do at a hit: which channel, which normal, which way.
#include <gtest/gtest.h>

#include "core/shading/surface.h"
#include "tests/support/scenes.h"

namespace petzval {
namespace {

/// A square of the plane z = 0 whose tangents run along x, with a material that a test fills.
struct Square {
    Scene scene;
    Material m = test::diffuse_material(0.5f);

    /// A slot whose picture is one texel.
    TextureSlot texel(uint8_t r, uint8_t g, uint8_t b, uint8_t a = 255) {
        scene.images.push_back({"", 1, 1, std::vector<uint8_t>{r, g, b, a}});
        TextureSlot slot;
        slot.image = static_cast<int32_t>(scene.images.size()) - 1;
        return slot;
    }
    [[nodiscard]] ShadingInput at_middle(const V3f& wo = V3f(0, 0, 1)) {
        Mesh mesh = test::quad(V3f(-1, -1, 0), V3f(2, 0, 0), V3f(0, 2, 0));
        mesh.normals.assign(4, V3f(0, 0, 1));
        mesh.tangents.assign(4, V4f(1, 0, 0, 1));
        test::place(scene, std::move(mesh), m);
        finish_scene(scene);
        Hit hit{};
        hit.barycentric = V2f(0.3f, 0.3f);
        return read_material(scene, make_surface(scene, -wo, hit), wo, Bands::rgb());
    }
};

void expect_near_rgb(const V3f& a, const V3f& b) {
    EXPECT_NEAR((a - b).length(), 0.f, 0.01f) << a << " and " << b;
}

TEST(MaterialLayers, FactorsAreMultipliedByTheirChannels) {
    Square s;
    s.m.coat = 0.5f;
    s.m.coat_texture = s.texel(102, 0, 0);
    s.m.coat_roughness = 0.5f;
    s.m.coat_roughness_texture = s.texel(0, 51, 0);
    s.m.sheen_color = Rgb(0.5f, 1, 1);
    s.m.sheen_color_texture = s.texel(255, 102, 51);
    s.m.sheen_roughness = 0.5f;
    s.m.sheen_roughness_texture = s.texel(0, 0, 0, 204);
    s.m.iridescence = 0.5f;
    s.m.iridescence_texture = s.texel(204, 0, 0);
    s.m.film_thinnest_nm = 100;
    s.m.film_thickest_nm = 600;
    s.m.film_thickness_texture = s.texel(0, 51, 0);
    s.m.diffuse_transmission = 0.5f;
    s.m.diffuse_transmission_texture = s.texel(0, 0, 0, 102);
    s.m.diffuse_transmission_color = Rgb(1, 0.5f, 1);
    s.m.diffuse_transmission_color_texture = s.texel(51, 255, 0);
    const ShadingInput in = s.at_middle();
    EXPECT_NEAR(in.coat.weight, 0.2f, 1e-6f);
    EXPECT_NEAR(in.coat.roughness, 0.1f, 1e-6f);
    EXPECT_NEAR(in.bsdf.sheen[0], 0.5f, 1e-6f);
    EXPECT_NEAR(in.bsdf.sheen[1], 0.4f, 1e-6f);
    EXPECT_NEAR(in.bsdf.sheen[2], 0.2f, 1e-6f);
    EXPECT_NEAR(in.bsdf.sheen_most, 0.5f, 1e-6f);
    EXPECT_NEAR(in.bsdf.sheen_roughness, 0.4f, 1e-6f);
    EXPECT_NEAR(in.bsdf.film_share, 0.4f, 1e-6f);
    EXPECT_NEAR(in.bsdf.film_thickness_nm, 200.f, 1e-3f);
    EXPECT_NEAR(in.bsdf.diffuse_transmission, 0.2f, 1e-6f);
    EXPECT_NEAR(in.bsdf.diffuse_transmission_color[0], 0.2f, 1e-6f);
    EXPECT_NEAR(in.bsdf.diffuse_transmission_color[1], 0.5f, 1e-6f);
}

TEST(MaterialLayers, AFilmWithoutATextureIsAsThickAsItMayBe) {
    Square s;
    s.m.iridescence = 1;
    EXPECT_EQ(s.at_middle().bsdf.film_thickness_nm, 400.f);
}

// Where light is not refracted, the film lies between the outside and the material from both sides,
// as Fresnel's reflectance does. Over glass, from within, it lies before the glass.
TEST(MaterialLayers, AFilmIsTheSameFromBothSides) {
    for (const bool volume : {false, true})
        for (const float side : {1.f, -1.f}) {
            Square s;
            s.m.iridescence = 1;
            s.m.film_ior = 1.8f;
            s.m.transmission = 1;
            s.m.has_volume = volume;
            const float front = volume && side < 0 ? s.m.ior : 1.f;
            const BsdfInput in = s.at_middle(V3f(0, 0, side)).bsdf;
            EXPECT_NEAR(in.film_index, 1.8f, 1e-6f) << volume << ' ' << side;
            if (volume) {
                EXPECT_NEAR(in.film_index_on_glass, 1.8f / front, 1e-6f) << side;
            }
        }
}

// A mapped normal about which the viewer's mirror image leaves the surface is kept; any other is
// turned in its plane with the surface's normal until the image grazes.
TEST(MaterialLayers, MappedNormalsAreBentUntilReflectionsLeave) {
    int kept = 0, bent = 0;
    for (const bool coat : {false, true})
        for (const float tilt_deg : {10.f, 30.f, 50.f, 80.f, 100.f, 170.f})
            for (const float view_deg : {-89.f, -60.f, -20.f, 0.f, 40.f, 80.f})
                for (const float side : {1.f, -1.f}) {
                    const float tilt = tilt_deg * kPi / 180, view = view_deg * kPi / 180;
                    Square s;
                    s.m.coat = coat ? 1.f : 0.f;
                    TextureSlot& slot = coat ? s.m.coat_normal_texture : s.m.normal_texture;
                    s.scene.images.push_back({"", 1, 1,
                                              std::vector<float>{std::sin(tilt) / 2 + 0.5f, 0.5f,
                                                                 std::cos(tilt) / 2 + 0.5f, 1.f}});
                    slot.image = 0;
                    const V3f wo = V3f(std::sin(view), 0.3f, std::cos(view)) * side;
                    const V3f to_eye = unit(wo), up = V3f(0, 0, side);
                    const ShadingInput in = s.at_middle(to_eye);
                    const V3f n = coat ? in.frame.to_world(in.coat.normal) : in.frame.z;
                    const V3f map = V3f(std::sin(tilt), 0, std::cos(tilt)) * side;
                    const auto height = [&](const V3f& m) {
                        return up.dot(m * (2 * m.dot(to_eye)) - to_eye);
                    };
                    const float most = std::min(0.01f, 0.5f * up.dot(to_eye));
                    EXPECT_GT(n.dot(to_eye), 0.f) << tilt_deg << ' ' << view_deg;
                    EXPECT_GT(height(n), 0.9f * most) << tilt_deg << ' ' << view_deg;
                    if (map.dot(to_eye) > 0.01f && height(map) > 0.02f) {
                        expect_near_rgb(n, map);
                        ++kept;
                    } else if (map.dot(to_eye) > 0.01f && height(map) < 0.f) {
                        EXPECT_NEAR(height(n), most, 1e-4f) << tilt_deg << ' ' << view_deg;
                        EXPECT_NEAR(n.y, 0.f, 1e-5f);
                        EXPECT_GE(n.x * side, -1e-5f);
                        ++bent;
                    }
                }
    EXPECT_GT(kept, 10);
    EXPECT_GT(bent, 10);
}

// (0.6, 0, 0.8) in each map, one turned; the coat without a map has the mesh's normal.
TEST(MaterialLayers, CoatAndBaseHaveNormalsOfTheirOwn) {
    const V3f along_x = unit(V3f(0.6f, 0, 0.8f)), along_y = unit(V3f(0, 0.6f, 0.8f));
    for (const bool base : {false, true})
        for (const bool coat : {false, true}) {
            Square s;
            s.m.coat = 1;
            if (base) s.m.normal_texture = s.texel(204, 128, 230);
            if (coat) s.m.coat_normal_texture = s.texel(128, 204, 230);
            const ShadingInput in = s.at_middle();
            expect_near_rgb(in.frame.z, base ? along_x : V3f(0, 0, 1));
            expect_near_rgb(in.frame.to_world(in.coat.normal), coat ? along_y : V3f(0, 0, 1));
        }
}

TEST(MaterialLayers, AnisotropyTurnsFromTheTangentTowardsTheBitangent) {
    Square plain;
    plain.m.anisotropy = 0.5f;
    expect_near_rgb(plain.at_middle().frame.x, V3f(1, 0, 0));
    EXPECT_EQ(plain.at_middle().bsdf.anisotropy, 0.5f);
    Square turned;
    turned.m.anisotropy = 0.5f;
    turned.m.anisotropy_rotation_rad = kPi / 6;
    expect_near_rgb(turned.at_middle().frame.x, V3f(std::sqrt(0.75f), 0.5f, 0));
    // The texture's direction, (1, 1/2), turned further; its strength is blue.
    Square mapped;
    mapped.m.anisotropy = 0.5f;
    mapped.m.anisotropy_rotation_rad = kPi / 6;
    mapped.m.anisotropy_texture = mapped.texel(255, 191, 102);
    const ShadingInput in = mapped.at_middle();
    const float angle_rad = std::atan(0.5f) + kPi / 6;
    expect_near_rgb(in.frame.x, V3f(std::cos(angle_rad), std::sin(angle_rad), 0));
    EXPECT_NEAR(in.bsdf.anisotropy, 0.2f, 1e-6f);
}

}  // namespace
}  // namespace petzval
