# A thin front for the CMake presets in CMakePresets.json. `make demo` and `make test` are all that
# a newcomer needs; both install what is missing first.

.PHONY: help packages program-packages build all package package-arm64 image archive wheel install site asset-maker live demo demonstration slam-judges pictures film test release-check check test-nightly test-asan test-tsan test-files fuzz mutants faults pairs verification determinism platforms format clean

PROGRAM := build/release/rubble
# Tests have one thread each, so as many run at once as there are processors.
CTEST   := ctest --output-on-failure --parallel $(shell nproc)

help:
	@echo "make demo       install what is missing, build, and run scripts/demo.lua"
	@echo "make test       install what is missing, build, and run the test suite"
	@echo "make check T=kernel  build and run the tests of one part, or suites of it: T=app.Batch"
	@echo "make demonstration  flights into a ruin, and what structure from motion makes of them; goes on where it stopped (docs/explanation/sfm.md)"
	@echo "make slam-judges  SLAM systems of PyPI on flights into the same ruin; goes on where it stopped (docs/explanation/slam_judges.md)"
	@echo "make pictures   draw the pictures of the documents anew, and docs/gallery.md; it goes on where it stopped"
	@echo "make film       make the film of the demo: docs/pictures/demo.mp4"
	@echo "make build      build the program and its assets only: $(PROGRAM)"
	@echo "make all        build everything, with the tests and benches"
	@echo "make install PREFIX=/usr/local  install the program, its assets, manual pages and completions"
	@echo "make package    make Debian packages: build/package/rubble_*.deb, librubble-dev_*.deb"
	@echo "make package-arm64  the same for arm64, cross-compiled and tried under an emulator (docs/how_to/install.md)"
	@echo "make image      make a container image: build/package/rubble_*_oci.tar (needs root)"
	@echo "make archive    make a self-extracting archive for other distributions: build/package/rubble-*.run"
	@echo "make wheel      make Python wheels: build/package/rubble_sim-*.whl; PYTHONS=\"python3.11 python3.12\" (docs/reference/python.md)"
	@echo "make site       make a site of the documents: build/site/index.html"
	@echo "make live       build everything, with publishing over ROS 1 and ROS 2 (docs/how_to/live.md)"
	@echo "make release-check  fail where a table of the documents was measured from older sources"
	@echo "make test-nightly  run the tests that take long, or need a cluster of one node"
	@echo "make test-asan  run the suite under AddressSanitizer and UndefinedBehaviorSanitizer"
	@echo "make test-tsan  run the suite under ThreadSanitizer"
	@echo "make test-files  try public robots, meshes and trajectories against figures of other programs (docs/development/reliability.md)"
	@echo "make fuzz SECONDS=60  run every fuzz target for this time, two at once (docs/development/reliability.md)"
	@echo "make mutants    break the code on purpose, one fault at a time: which tests notice? (half an hour)"
	@echo "make faults     interrupt a small run at many places, continue it, compare the bytes (an hour)"
	@echo "make pairs      any two features of a mission together, judged by their data; goes on where it stopped (docs/development/pairs.md)"
	@echo "make verification  piles, ruins and a robot at shorter steps and with more sweeps (docs/explanation/verification.md)"
	@echo "make determinism  compare hashes of other compilers, levels, processors and libraries (half an hour, and longer for whole missions)"
	@echo "make platforms PLATFORM=debian13  demo and tests in a bare Debian 13; or windows, riscv64, arm64 (docs/development/platforms.md)"
	@echo "make format     clang-format over the tree"
	@echo "make clean      remove build/ and out/"

packages:
	@tools/install_packages.sh packages.txt

program-packages:
	@tools/install_packages.sh --program packages.txt

build/%/build.ninja: | packages
	cmake --preset $*

build/release/build.ninja: | program-packages
	cmake --preset release -DBUILD_TESTING=OFF

# The program alone, half of what there is to compile.
build: program-packages build/release/build.ninja
	cmake --build --preset release --target program

all: packages
	cmake --preset release -DBUILD_TESTING=ON
	cmake --build --preset release

# Whatever the folder is called later: the program finds its assets from where it is.
PREFIX := /usr/local
install: build
	cmake --install build/release --prefix $(PREFIX)

package: build
	cpack --config build/release/CPackConfig.cmake -B build/package

# Cross-compiled, and tried under an emulator.
package-arm64: build
	@tools/install_packages.sh tools/packages-arm64.txt
	tools/package_arm64.sh

image: package
	@tools/install_packages.sh tools/packages-nightly.txt
	tools/package/make_image.sh build/package/rubble_*_$$(dpkg --print-architecture).deb build/package/image \
	  build/package/rubble_$$(sed -n 's/^CMAKE_PROJECT_VERSION:STATIC=//p' build/release/CMakeCache.txt)_$$(dpkg --print-architecture)_oci.tar

archive: build
	@tools/install_packages.sh tools/packages-nightly.txt
	tools/package/make_archive.sh build/release build/package

# One for Python 3.11, and one for all newer ones.
PYTHONS = $(shell tools/wheel/find_pythons.py)
wheel: packages build
	tools/wheel/make_wheels.sh build/release build/package $(PYTHONS)

site:
	@tools/install_packages.sh tools/packages-site.txt
	tools/make_site.py build/site_source
	mkdocs build --strict --quiet
	cmake --preset release >/dev/null && cmake --build --preset release --target rubble_public_headers
	doxygen tools/Doxyfile

# With the optional parts that publish over ROS; CMake looks for them anew.
live: packages
	@tools/install_packages.sh tools/packages-live.txt
	cmake --preset release -DBUILD_TESTING=ON
	cmake --build --preset release

# A dataset with its contact sheet and its page.
demo: build
	$(PROGRAM) run scripts/demo.lua --out out/demo --force
	@$(PROGRAM) view out/demo > /dev/null
	@echo "Open the contact sheet out/demo/preview.png, and the page out/demo/view.html in a browser."

# DEMONSTRATION_OPTIONS: see bench/demonstration/run, as in DEMONSTRATION_OPTIONS="--size small --hours 2 --seeds 1".
demonstration: build
	bench/demonstration/run --document $(DEMONSTRATION_OPTIONS)

# SLAM_OPTIONS: see bench/demonstration/slam, as in SLAM_OPTIONS="--hours 2 --seeds 1".
slam-judges: build
	bench/demonstration/slam --document $(SLAM_OPTIONS)

# All pictures of the documents but the film, and the tables that are drawn with them; hours. It goes on where it stopped.
# PICTURES: some of the steps alone, as in PICTURES="demo drive"; tools/draw_pictures.py --list has their names.
pictures: packages build/release/build.ninja
	@tools/install_packages.sh tools/packages-pictures.txt
	@grep -q '^BUILD_TESTING:BOOL=ON' build/release/CMakeCache.txt || cmake --preset release -DBUILD_TESTING=ON
	cmake --build --preset release --target program gallery python
	tools/draw_pictures.py $(PICTURES)

film: build
	@tools/install_packages.sh tools/packages-pictures.txt
	rm -rf out/film
	tools/draw_film.py --program $(PROGRAM)

# What tests make once and share (baked light, textures) is made anew, by the program that is tested.
test: all
	rm -rf build/release/cache
	$(CTEST) --preset release --label-exclude nightly
	@tools/stale_tables.py

# What a release needs besides the tests.
release-check:
	tools/stale_tables.py --strict

# The tests of one folder of tests/, or some suites of it: T=kernel, T=app.Batch (a regular expression of their names).
T := kernel
check: packages build/release/build.ninja
	@grep -q '^BUILD_TESTING:BOOL=ON' build/release/CMakeCache.txt || cmake --preset release -DBUILD_TESTING=ON
	cmake --build --preset release --target tests_$(firstword $(subst ., ,$(T)))
	$(CTEST) --preset release --label-exclude "nightly|slow" --tests-regex '^$(subst .,\.,$(T))'

test-nightly: live
	@tools/install_packages.sh tools/packages-nightly.txt tools/packages-sfm.txt tools/packages-site.txt
	$(CTEST) --preset release --label-regex nightly
	$(MAKE) fuzz SECONDS=4  # of each target: a minute in all, two at once

# See RUBBLE_ASSET_MAKER in assets/CMakeLists.txt.
asset-maker: program-packages build/release/build.ninja
	cmake --build --preset release --target rubble_make_assets

build/asan/build.ninja build/tsan/build.ninja: | asset-maker
test-asan test-tsan: asset-maker

test-asan test-tsan: test-%: packages build/%/build.ninja
	cmake --build --preset $*
	$(CTEST) --preset $* --label-exclude "slow|nightly"

# Not part of any suite: it downloads 1.3 GB of packages. FILES_OPTIONS: see tests/files/run_files.py.
test-files: build
	tests/files/run_files.py $(PROGRAM) build/files $(FILES_OPTIONS)

# TARGETS: some of tests/fuzz alone, as in TARGETS="ply_map pack".
SECONDS := 60
fuzz: build
	@tools/install_packages.sh tools/packages-fuzz.txt
	cmake --preset fuzz
	cmake --build --preset fuzz
	tests/fuzz/make_corpus.py . $(PROGRAM) build/fuzz/seeds
	tests/fuzz/run_fuzz.py build/fuzz build/fuzz/seeds $(SECONDS) $(TARGETS)

# NAMES: some of the faults alone, as in NAMES=light_falls_with_distance.
mutants: all
	tests/mutants/run_mutants.py $(NAMES)

# 200 kills, and 40 places of each call that can fail.
faults: build
	tests/faults/run_faults.py $(PROGRAM) build/faults 200 40

# Two hours on two processors at most; what is done is kept in build/pairs, by the hash of the program.
# PAIRS_OPTIONS: see tests/pairs/run_pairs.py.
pairs: all
	tests/pairs/run_pairs.py $(PROGRAM) build/pairs --python build/release/python --report docs/development/pairs.md $(PAIRS_OPTIONS)

# Figures at shorter steps and with more sweeps (docs/explanation/verification.md): about an hour; goes on where it stopped.
verification: build/release/build.ninja
	@tools/install_packages.sh tools/packages-pictures.txt
	cmake --build --preset release --target verification_bench
	build/release/verification_bench --jobs 2 --out build/verification.jsonl
	/usr/bin/python3 bench/verification/page.py build/verification.jsonl

# Not part of any suite: it installs compilers, builds the kernel fifteen times, and runs the suite of missions six times.
# DETERMINISM_OPTIONS: see tools/determinism_matrix.sh, as in DETERMINISM_OPTIONS=--missions.
determinism: packages build
	@tools/install_packages.sh tools/packages-determinism.txt
	tools/determinism_matrix.sh $(DETERMINISM_OPTIONS)

# Not part of any suite: it installs compilers and emulators and builds the kernel four times; and all of it, with
# the suite, in a bare Debian 13. PLATFORM: some of the platforms alone, as in PLATFORM=debian13.
platforms: packages
	@tools/install_packages.sh tools/packages-platforms.txt
	tools/platforms.sh $(PLATFORM)

format:
	git ls-files '*.h' '*.cpp' | xargs clang-format -i

clean:
	rm -rf build out
