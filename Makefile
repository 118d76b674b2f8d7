# SPDX-License-Identifier: Apache-2.0
# Two commands for a fresh Debian 12 or 13: make render, make test. Everything else is CMake's.
PACKAGES = cmake ninja-build ccache mold pkg-config libembree-dev libtbb-dev libimath-dev libopenimageio-dev \
    openimageio-tools libopencolorio-dev libtinygltf-dev nlohmann-json3-dev libfmt-dev \
    libcli11-dev libpugixml-dev libdraco-dev libmeshoptimizer-dev libfreetype-dev libcpp-httplib-dev \
    libkissfft-dev
# What draws plots, and the letters on contact sheets.
OPTIONAL_PACKAGES = gnuplot-nox fonts-dejavu-core
PYTHON_PACKAGES = pybind11-dev python3-dev python3-numpy
TEST_PACKAGES = $(OPTIONAL_PACKAGES) $(PYTHON_PACKAGES) libgtest-dev libgmock-dev libbenchmark-dev python3-pytest
LONG_PACKAGES = clang clang-tidy libclang-rt-dev gcovr debootstrap qemu-user blender chromium-driver python3-selenium
SOURCES = git ls-files '*.h' '*.cpp'
PREFIX = /usr/local

.PHONY: render gallery test test-files test-long program python blender build install uninstall deb tarball format format-check

render: program
	mkdir -p out
	build/bin/petzval render assets/scenes/first_light.glb --fstop 2 --focus 1m --size 960x540 --spp 256 \
	    -o out/first_light.exr -o out/first_light.png

# About half an hour of CPU time; GALLERY_SPP=16 for a first look.
gallery: program
	@.ci/install_packages $(OPTIONAL_PACKAGES)
	GALLERY_DOCS=docs/pictures/gallery tests/make/gallery.sh

test: build
	ctest --preset release --parallel $$(nproc)
	@echo "The ten slowest tests, in seconds:"
	@sed '/^---/,$$d' build/Testing/Temporary/CTestCostData.txt | sort -k3,3 -nr | awk 'NR <= 10 { printf "%7.1f  %s\n", $$3, $$1 }'

# What reads files, under the address and undefined-behaviour sanitizers.
test-files:
	@.ci/install_packages $(PACKAGES) $(TEST_PACKAGES)
	cmake --preset asan
	cmake --build --preset asan-files
	ctest --preset asan-files --parallel $$(nproc)

# All that takes too long for each merge: hours on two cores. tests/long.sh NAME... runs a part of it.
test-long: build
	@.ci/install_packages $(LONG_PACKAGES)
	tests/long.sh

# The program alone, without tests and benchmarks.
program:
	@.ci/install_packages $(PACKAGES)
	cmake --preset program
	cmake --build --preset program

# For PYTHONPATH=build/python
python:
	@.ci/install_packages $(PACKAGES) $(PYTHON_PACKAGES)
	cmake --preset program
	cmake --build --preset program --target all petzval_python

# Everything: the program, the tests, the measuring programs.
build:
	@.ci/install_packages $(PACKAGES) $(TEST_PACKAGES)
	cmake --preset release
	cmake --build --preset release

# The program, its manual, and what other programs link: under PREFIX, below DESTDIR.
install: program
	cmake --install build --prefix "$(PREFIX)"
	cp build/install_manifest.txt build/installed_files.txt  # tests install too

# With the same DESTDIR.
uninstall:
	DESTDIR="$(DESTDIR)" apps/package/uninstall.sh build/installed_files.txt

# Debian packages for the release that this runs on: build/packages/*.deb
deb: python
	@.ci/install_packages dpkg-dev file
	cd build && cpack -G DEB -B packages

# A folder with its libraries, for any Linux with this one's glibc or newer: build-tarball/petzval-*.tar.xz
tarball:
	apps/package/tarball.sh $(PACKAGES)

# The add-on for Blender, to be installed in its preferences: build/petzval_blender.zip
blender:
	apps/blender/pack.sh build/petzval_blender.zip

format:
	@.ci/install_packages clang-format
	$(SOURCES) | xargs clang-format -i

format-check:
	@.ci/install_packages clang-format
	$(SOURCES) | xargs clang-format --dry-run --Werror
