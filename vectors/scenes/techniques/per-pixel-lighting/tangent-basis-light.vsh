vs.1.1                          ; the rows of the matrix from tangent space to the world, and the light in tangent space as a colour
; c0: world, view and projection, c12: toward the light, c20: one half
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
dp3 r6.x, v8, c12
dp3 r6.y, v9, c12
dp3 r6.z, v3, c12
mad oD0.xyz, r6.xyz, c20.xyz, c20.xyz
