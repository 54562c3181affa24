// Set operations by CGAL's corefinement of surface meshes (package Polygon_mesh_processing). CGAL's
// part of it is under the GPL: a program that is built with this file is, too.

#include "geom/mesh/boolean_cgal.h"

#include <cstdlib>
#include <exception>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_exact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Polygon_mesh_processing/self_intersections.h>
#include <CGAL/Surface_mesh.h>

namespace {

namespace PMP = CGAL::Polygon_mesh_processing;
using Kernel = CGAL::Exact_predicates_exact_constructions_kernel;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Face = Mesh::Face_index;
using Origin = std::pair<uint32_t, uint32_t>; // operand, triangle
using Origins = Mesh::Property_map<Face, Origin>;

Origins origins_of(Mesh &mesh) {
  return mesh.add_property_map<Face, Origin>("f:cag_origin", Origin(0, 0)).first;
}

// Hands each face's origin on to the faces that it is cut into and copied to.
struct Follower : PMP::Corefinement::Default_visitor<Mesh> {
  Origin current;
  void before_subface_creations(Face old, Mesh &mesh) { current = origins_of(mesh)[old]; }
  void after_subface_created(Face made, Mesh &mesh) { origins_of(mesh)[made] = current; }
  void after_face_copy(Face from, const Mesh &source, Face to, Mesh &target) {
    origins_of(target)[to] = origins_of(const_cast<Mesh &>(source))[from];
  }
};

bool read(const BoolCgalMesh &in, uint32_t operand, Mesh &mesh) {
  for (size_t i = 0; i < in.point_count; i++)
    mesh.add_vertex(Kernel::Point_3(in.points[3 * i], in.points[3 * i + 1], in.points[3 * i + 2]));
  Origins origins = origins_of(mesh);
  for (uint32_t t = 0; t < in.triangle_count; t++) {
    const uint32_t *k = in.triangles + 3 * size_t(t);
    const Face face =
        mesh.add_face(Mesh::Vertex_index(k[0]), Mesh::Vertex_index(k[1]), Mesh::Vertex_index(k[2]));
    if (face == Mesh::null_face()) return false; // an edge of more than two triangles
    origins[face] = Origin(operand, t);
  }
  return CGAL::is_closed(mesh) && CGAL::is_valid_polygon_mesh(mesh) &&
         !PMP::does_self_intersect(mesh) &&
         (in.triangle_count == 0 || PMP::does_bound_a_volume(mesh));
}

template <class T> T *room_for(size_t n) {
  return static_cast<T *>(std::malloc((n + 1) * sizeof(T)));
}

bool write(Mesh &mesh, BoolCgalMesh &out) {
  Origins origins = origins_of(mesh);
  std::vector<uint32_t> number(mesh.number_of_vertices() + mesh.number_of_removed_vertices());
  const size_t triangles = mesh.number_of_faces();
  out.points = room_for<double>(3 * mesh.number_of_vertices());
  out.triangles = room_for<uint32_t>(3 * triangles);
  out.operand = room_for<uint32_t>(triangles);
  out.source = room_for<uint32_t>(triangles);
  if (!out.points || !out.triangles || !out.operand || !out.source) return false;
  for (Mesh::Vertex_index v : mesh.vertices()) {
    number[v] = uint32_t(out.point_count);
    for (int k = 0; k < 3; k++)
      out.points[3 * out.point_count + size_t(k)] = CGAL::to_double(mesh.point(v)[k]);
    out.point_count++;
  }
  for (Face f : mesh.faces()) {
    uint32_t *to = out.triangles + 3 * out.triangle_count;
    for (Mesh::Vertex_index v : CGAL::vertices_around_face(mesh.halfedge(f), mesh))
      *to++ = number[v];
    out.operand[out.triangle_count] = origins[f].first;
    out.source[out.triangle_count++] = origins[f].second;
  }
  return true;
}

bool operate(int operation, Mesh &a, Mesh &b, Mesh &out) {
  Follower follower;
  const auto how = CGAL::parameters::visitor(follower).throw_on_self_intersection(true);
  if (operation == 0) return PMP::corefine_and_compute_union(a, b, out, how);
  if (operation == 1) return PMP::corefine_and_compute_difference(a, b, out, how);
  return PMP::corefine_and_compute_intersection(a, b, out, how);
}

} // namespace

extern "C" bool bool_cgal_operate(int operation, const BoolCgalMesh operands[2],
                                  BoolCgalMesh *out) {
  *out = BoolCgalMesh();
  bool done = false;
  try {
    Mesh a, b, result;
    done = read(operands[0], 0, a) && read(operands[1], 1, b) && operate(operation, a, b, result) &&
           write(result, *out);
  } catch (const std::exception &) { done = false; }
  if (done) return true;
  std::free(out->points);
  std::free(out->triangles);
  std::free(out->operand);
  std::free(out->source);
  *out = BoolCgalMesh();
  return false;
}
