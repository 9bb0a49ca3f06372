vs.1.1                          ; the normal as a colour and as coordinates, the half vector as coordinates
; c0: world, view and projection, c5: half vector, c20: one half
m4x4 oPos, v0, c0
mad oD0.xyz, v3.xyz, c20.xyz, c20.xyz
mov oT0.xyz, v3.xyz
mov oT1.xyz, c5.xyz
mov oT2.xyz, c5.xyz
