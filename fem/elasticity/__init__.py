"""Elasticity of a section and of a prism: elements, loads at a point, cyclic structures.

What a gear is made of, without teeth that mesh: element matrices and their condensation, singular fields of a load
on an edge, waves along the face and free ends, torsion of steps, supports, stress along a free edge, and the energy
of third order.

Public, in `fem`: `Support`.
"""
