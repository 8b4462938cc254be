// A settled pile as one mesh file for other programs. Metres and right-handed everywhere; Z up
// but for glTF, which wants Y up: (x, y, z) becomes (x, z, -y).
//
//   ply   binary; distinct positions, each with its piece's number and a colour
//   obj   and .mtl beside it; one object per piece, distinct positions without normals, materials
//   glb   glTF 2.0; one mesh per asset, one node per piece with its pose and scale, materials
#pragma once

#include <string>
#include <vector>

#include "io/mesh/pile_model.h"
#include "kernel/base/mesh.h"
#include "kernel/model/track.h"

namespace rubble {

// Each throws RunError when the file cannot be written.
void write_ply(const std::string& path, const PileModel& model);
void write_obj(const std::string& path, const PileModel& model);  // and .mtl for .obj
void write_glb(const std::string& path, const PileModel& model);

// Who moved when as a glTF animation: the pile of pile.glb, and a clip in which every piece goes the way
// of its track. Y up, as in every .glb of ours.
//
// Each piece that moves has a channel for its translation and one for its rotation, keyed where the
// track is and linear in between; a piece that is not there has the scale 0. Times of the clip are those
// of the track; unit: s.
// model: pieces with their numbers, those that the pile lost, too. A piece that is not in the track
// stands still. Throws RunError when the file cannot be written.
void write_track_glb(const std::string& path, const PileModel& model, const Track& track);

// The parts of an OBJ file that both the whole pile and single meshes are made of.

// What is in the file before an object.
struct ObjCounts {
  std::size_t positions = 0, normals = 0, places = 0;
};

// solid: positions and faces. Readers split a corner whose faces have several normals or places in pictures, and then find
// no closed mesh. looks: with normals where they are not those of the faces, and with places of surfaces with a picture.
enum class ObjContent { solid, looks };

// Appends one object and adds it to the counts. Positions that are equal are one.
void put_obj_object(std::string& text, const PileModel::Piece& piece, const TriangleMesh& mesh,
                    const WeldedMesh& welded, ObjContent content, ObjCounts& counts);

// A material. picture: name of its file; empty: none. colour: linear light.
std::string mtl_text(const std::string& name, const Vec3f& colour, const std::string& picture = "");

// A surface's paint as glTF has it: images as PNG, and vertices of its own.

// The bytes of PNG files; empty where the paint has no such image.
struct GlbImages {
  std::string base_colour, metallic_roughness, normal;
};
GlbImages make_glb_images(const SurfacePaint& paint);

// The corners of the triangles of one surface, each a vertex: two triangles may differ in them where they meet.
struct GlbCorners {
  std::vector<Vec3f> positions, normals, colours;  // in the mesh frame; normals of faces where the mesh has none
  std::vector<Vec3f> tangents;                     // unit, to the right in the images
  std::vector<float> handedness;                   // -1 where the images are mirrored, else 1
  std::vector<float> places;                       // u, v of each, v downwards
  bool coloured = false;                           // some colour is not white
};
GlbCorners make_glb_corners(const TriangleMesh& mesh, std::size_t surface);

}  // namespace rubble
