vs.1.1                          ; the axis of the sky in tangent space, as a colour
; c0: world, view and projection, c10: axis of the sky, c20: one half
m4x4 oPos, v0, c0
dp3 r5.x, v8, c10
dp3 r5.y, v9, c10
dp3 r5.z, v3, c10
mad oD0.xyz, r5.xyz, c20.xyz, c20.xyz
mov oT0.xy, v7.xy
mov oT1.xy, v7.xy
