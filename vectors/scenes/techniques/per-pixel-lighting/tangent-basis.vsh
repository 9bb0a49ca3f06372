vs.1.1                          ; the rows of the matrix from tangent space to the world
; c0: world, view and projection
m4x4 oPos, v0, c0
mov oT0.xy, v7.xy
mov oT1.x, v8.x
mov oT1.y, v9.x
mov oT1.z, v3.x
mov oT2.x, v8.y
mov oT2.y, v9.y
mov oT2.z, v3.y
mov oT3.x, v8.z
mov oT3.y, v9.z
mov oT3.z, v3.z
