#!/usr/bin/env python3
"""Writes STEP files of solids whose surfaces are described in unusual ways, which the standard allows.

    turned_step.py cone     a frustum, z from 0 to 6, radii 5 and 2: on the far side of the cone's apex, where its radii are negative
    turned_step.py copies   the frustum, and two copies: moved by 20 along x; moved by 20 along y with its axis along x
    turned_step.py torus    a barrel, z from -3 to 3: the part of a torus of radii 4 and 9 within itself
"""

import math
import sys


class File:
    def __init__(self):
        self.lines = []

    def add(self, text, *values):
        self.lines.append("#%d=%s;" % (len(self.lines) + 1, text % values if values else text))
        return len(self.lines)

    def triple(self, kind, xyz):
        return self.add("%s('',(%s))", kind, ",".join(repr(float(x)) for x in xyz))

    def frame(self, origin, z=(0, 0, 1), x=(1, 0, 0)):
        return self.add("AXIS2_PLACEMENT_3D('',#%d,#%d,#%d)", self.triple("CARTESIAN_POINT", origin), self.triple("DIRECTION", z),
                        self.triple("DIRECTION", x))

    def vertex(self, point):
        return self.add("VERTEX_POINT('',#%d)", self.triple("CARTESIAN_POINT", point))

    def circle(self, z, radius, vertex):
        curve = self.add("CIRCLE('',#%d,%r)", self.frame((0, 0, z)), float(radius))
        return self.add("EDGE_CURVE('',#%d,#%d,#%d,.T.)", vertex, vertex, curve)

    def face(self, surface, *edges):
        """Edges with their directions."""
        uses = ["#%d" % self.add("ORIENTED_EDGE('',*,*,#%d,.%s.)", edge, "T" if forward else "F") for edge, forward in edges]
        loop = self.add("EDGE_LOOP('',(%s))", ",".join(uses))
        return self.add("ADVANCED_FACE('',(#%d),#%d,.T.)", self.add("FACE_OUTER_BOUND('',#%d,.T.)", loop), surface)

    def plane(self, z, up, edge):
        return self.face(self.add("PLANE('',#%d)", self.frame((0, 0, z), (0, 0, 1 if up else -1))), (edge, up))

    def text(self, faces, copies=()):
        """Copies are frames, into which the solid at the origin is placed."""
        brep = self.add("MANIFOLD_SOLID_BREP('solid',#%d)",
                        self.add("CLOSED_SHELL('',(%s))", ",".join("#%d" % face for face in faces)))
        length = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))")
        angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))")
        space = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())")
        error = self.add("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-6),#%d,'','')", length)
        context = self.add("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#%d))"
                           "GLOBAL_UNIT_ASSIGNED_CONTEXT((#%d,#%d,#%d))REPRESENTATION_CONTEXT('',''))", error, length, angle, space)
        shape = self.add("ADVANCED_BREP_SHAPE_REPRESENTATION('',(#%d),#%d)", brep, context)
        application = self.add("APPLICATION_CONTEXT('automotive design')")
        product = self.add("PRODUCT('solid','solid','',(#%d))", self.add("PRODUCT_CONTEXT('',#%d,'mechanical')", application))
        formation = self.add("PRODUCT_DEFINITION_FORMATION('','',#%d)", product)
        stage = self.add("PRODUCT_DEFINITION_CONTEXT('part definition',#%d,'design')", application)
        definition = self.add("PRODUCT_DEFINITION('design','',#%d,#%d)", formation, stage)
        self.add("SHAPE_DEFINITION_REPRESENTATION(#%d,#%d)", self.add("PRODUCT_DEFINITION_SHAPE('','',#%d)", definition), shape)
        if copies:
            self.assemble(copies, context, formation, stage, definition, shape)
        return ("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"
                "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n" + "\n".join(self.lines) + "\nENDSEC;\nEND-ISO-10303-21;\n")


    def assemble(self, copies, context, formation, stage, part, shape):
        whole = self.add("PRODUCT_DEFINITION('design','',#%d,#%d)", formation, stage)
        home = self.frame((0, 0, 0))
        frames = ",".join("#%d" % copy for copy in copies)
        places = self.add("SHAPE_REPRESENTATION('',(%s),#%d)", frames, context)
        self.add("SHAPE_DEFINITION_REPRESENTATION(#%d,#%d)", self.add("PRODUCT_DEFINITION_SHAPE('','',#%d)", whole), places)
        for copy in copies:
            use = self.add("NEXT_ASSEMBLY_USAGE_OCCURRENCE('%d','','',#%d,#%d,$)" % (copy, whole, part))
            map_ = self.add("ITEM_DEFINED_TRANSFORMATION('','',#%d,#%d)", home, copy)
            relation = self.add("(REPRESENTATION_RELATIONSHIP('','',#%d,#%d)REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#%d)"
                                "SHAPE_REPRESENTATION_RELATIONSHIP())", shape, places, map_)
            self.add("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#%d,#%d)", relation, self.add("PRODUCT_DEFINITION_SHAPE('','',#%d)", use))


def turned(file, surface, seam, low, high, copies=()):
    """A solid between two circles, each of z and radius; `seam` is the curve between them at y = 0."""
    ends = [file.vertex((radius, 0, z)) for z, radius in (low, high)]
    rims = [file.circle(z, radius, end) for (z, radius), end in zip((low, high), ends)]
    edge = file.add("EDGE_CURVE('',#%d,#%d,#%d,.T.)", *ends, seam)
    side = file.face(surface, (rims[0], True), (edge, True), (rims[1], False), (edge, False))
    return file.text([side, file.plane(low[0], False, rims[0]), file.plane(high[0], True, rims[1])], copies)


def far_cone(copied=False):
    """The radius is 5 - z / 2; the cone is given by its circle at z = 14, where this is -2."""
    file = File()
    surface = file.add("CONICAL_SURFACE('',#%d,2.,%r)", file.frame((0, 0, 14)), math.atan(0.5))
    along = file.add("VECTOR('',#%d,1.)", file.triple("DIRECTION", (-3, 0, 6)))
    seam = file.add("LINE('',#%d,#%d)", file.triple("CARTESIAN_POINT", (5, 0, 0)), along)
    copies = [file.frame((0, 0, 0)), file.frame((20, 0, 0)), file.frame((0, 20, 0), (1, 0, 0), (0, 1, 0))] if copied else []
    return turned(file, surface, seam, (0, 5), (6, 2), copies)


def inner_torus(major=4, minor=9, half=3):
    file = File()
    surface = file.add("TOROIDAL_SURFACE('',#%d,%r,%r)", file.frame((0, 0, 0)), float(major), float(minor))
    # The arc turns from z to x, about -y, from below.
    seam = file.add("CIRCLE('',#%d,%r)", file.frame((-major, 0, 0), (0, -1, 0)), float(minor))
    radius = math.sqrt(minor**2 - half**2) - major
    return turned(file, surface, seam, (-half, radius), (half, radius))


KINDS = {"cone": far_cone, "copies": lambda: far_cone(True), "torus": inner_torus}

if __name__ == "__main__":
    sys.stdout.write(KINDS[sys.argv[1]]())
