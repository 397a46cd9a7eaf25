/// Triangle strips. Scanners use them to store surfaces in PLY files.
#pragma once

#include "alcove/mesh/formats/ply/ply_parse.h"

namespace alcove {

/// Adds the triangles of the element `tristrips` to the mesh, which already has its vertices, and replaces the element
/// by an element `face`. In a list, -1, or the largest value of an unsigned type, separates two strips. Every other
/// triangle of a strip is turned over, so that all get the same orientation. Triangles that repeat a vertex only
/// connect others and are left out. \throw InputError for an index out of range.
void read_strips(const FileBytes& file, PlyHeader& header, Mesh& mesh);

}
