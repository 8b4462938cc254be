// One web page that shows a dataset in three dimensions.
#pragma once

#include <string>

#include "app/mission/finished_run.h"

namespace rubble {

struct ViewOptions {
  int frames = 24;              // pictures of frames, at most, evenly over the flight
  int width = 480;              // of a picture; unit: pixel
  int triangles = 1'500'000;    // of all pieces together, about: coarser meshes are taken above it
};

// Pieces with their plain colours, the surfaces of voids that `rubble voids` left in the folder, the way
// of the camera and pictures of its frames; with the viewer, so that the page needs neither server nor
// network. assets: of the run. Throws InputError for a pile.bin or groundtruth.txt that is not sound.
std::string make_dataset_page(const FinishedRun& saved, const AssetLibrary& assets,
                              const ViewOptions& options);

// How many surfaces in the folder `voids` are of another pile, or do not say of which: the page leaves them out.
int count_voids_of_other_piles(const FinishedRun& saved);

// The scripts of the page that shows a dataset, compiled in: app/view/viewer.js, and three.js as Debian
// has it. Made by CMake.
std::string viewer_code();
std::string three_code();  // empty where libjs-three was not installed when the program was built

}  // namespace rubble
