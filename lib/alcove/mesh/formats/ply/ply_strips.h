/// Triangle strips: how scanners store the surface of a PLY file.
#pragma once

#include "alcove/mesh/formats/ply/ply_parse.h"

namespace alcove {

/// Adds the triangles of the element `tristrips` to the mesh, whose vertices are read, and replaces the element by
/// their `face`. -1, or the largest value of an unsigned type, separates two strips in one list. Triangles alternate in
/// orientation. Triangles that repeat a vertex only connect others, and are left out. \throw InputError for an index
/// out of range.
void read_strips(const FileBytes& file, PlyHeader& header, Mesh& mesh);

}
