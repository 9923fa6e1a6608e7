"""Operations on numbers: traced arithmetic, double-doubles, the arctangent, vectors in the plane.

They know nothing of mechanics; all of physics may import them.
"""
