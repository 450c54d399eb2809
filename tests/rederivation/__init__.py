"""The source documents' equations again, in plain NumPy, to test the compiled library against.

Nothing here imports the library, and nothing here copies a formula from it: single cylinders are
worked out in the time domain from the geometry, engines by adding up cylinders instant by instant,
orders by a discrete Fourier transform of what comes out. Where a source has its own way of writing
a sum (phase lags, three lists, cosine sums), that way is kept, slips corrected and named.

``kinematics``    how one slider-crank moves, and what its forces do to the block
``time_domain``   what a whole engine does at each crank angle, and its orders by Fourier transform
``rotors``        what turns with the crankshaft and on balance shafts
``ijesc``         the V6 tables of peak moments over V-angle and firing order
``ebook``         the e-book's engines as three lists, with its tables
``crossplane``    the page on the cross-plane V8's inertia forces and couples
``ito``           Ito and Hattori's V-14: bank sums, arrangements, bank angles
``firing``        when cylinders fire, by trying every choice of turns; pins of a firing order
``harmonics_mp``  the harmonics of one cylinder to fifty digits
``exact_sums``    which sums over an engine are zero, to sixty digits
"""
